#pragma once

/// @file first_facets.h
/// The boundary of the first mesh, from which others come by cutting cells: functions that are linear on its
/// facets are the same on all meshes.

#include <cstddef>
#include <span>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

template <int dim>
struct CellRecord;

/// The facets of the boundary groups as the first mesh has them.
struct FirstFacets
{
  std::vector<int> tags;        ///< per facet: position in MeshLabels::boundary_names
  std::vector<Index> vertices;  ///< dim per facet; two facets share those that they share in the mesh
  std::vector<double> points;   ///< dim coordinates per vertex

  template <int dim>
  [[nodiscard]] std::span<const Index, dim> vertices_of(std::size_t facet) const
  {
    return std::span<const Index, dim>(&vertices[facet * dim], dim);
  }
  template <int dim>
  [[nodiscard]] Point<dim> point(Index vertex) const
  {
    return Point<dim>(&points[static_cast<std::size_t>(dim) * vertex]);
  }
};

/// The facets of a first mesh. `boundary`: as find_boundary() gives it.
template <int dim>
[[nodiscard]] FirstFacets first_facets(const MeshData<dim>& data, std::span<const BoundaryFacet> boundary);
/// The same for a first mesh of which each rank has some cells, on all ranks. They call it together.
template <int dim>
[[nodiscard]] FirstFacets first_facets(const Ranks& ranks, std::span<const CellRecord<dim>> cells);

}  // namespace tribound::mesh
