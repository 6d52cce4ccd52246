#pragma once

/// @file outer_facets.h
/// The facets with one cell, prepared for searches: they are where a mesh may touch or cross itself.

#include <array>
#include <vector>

#include "tribound/mesh/geometry.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Whatever is nearer to a facet than this multiple of its diameter lies on it and does not cross it.
inline constexpr double coincidence = 1e-9;

/// A facet of the topology with one cell.
template <int dim>
struct OuterFacet
{
  Index number;  ///< in the topology
  std::array<Index, dim> vertices;
  std::array<Point<dim>, dim> points;
  Point<dim> normal;  ///< unit vector out of the cell
  double diameter;
};

/// All outer facets, cell by cell; the cells may be unverified.
template <int dim>
[[nodiscard]] std::vector<OuterFacet<dim>> outer_facets(const MeshData<dim>& data,
                                                        const Topology<dim>& topology)
{
  std::vector<OuterFacet<dim>> outer;
  for (std::size_t c = 0; c < data.cells.size(); ++c)
    for (int i = 0; i <= dim; ++i)
    {
      const Index number = topology.cell_facets[c][i];
      if (topology.facet_cells[number][1] >= 0) continue;
      const auto points = points_of<dim>(data.vertices, topology.facets[number]);
      const Point<dim> edge = points[1] - points[0];
      Point<dim> normal;
      if constexpr (dim == 2)
        normal = Point<2>(edge[1], -edge[0]).normalized();
      else
        normal = cross(edge, points[2] - points[0]).normalized();
      if (normal.dot(data.vertices[data.cells[c][i]] - points[0]) > 0) normal = -normal;
      outer.push_back({number, topology.facets[number], points, normal, diameter(points)});
    }
  return outer;
}

}  // namespace tribound::mesh
