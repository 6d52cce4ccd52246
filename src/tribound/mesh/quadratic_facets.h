#pragma once

/// @file quadratic_facets.h
/// The facets of the first mesh: the curved ones, of which cells only have the vertices, and all.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "tribound/mesh/first_facets.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Vertices and edges of a facet.
template <int dim>
inline constexpr int n_facet_nodes = dim*(dim + 1) / 2;

/// (t_y, -t_x) of a tangent in 2D, t x s of two in 3D.
template <int dim>
[[nodiscard]] Point<dim> normal_of(const std::array<Point<dim>, dim - 1>& tangents)
{
  if constexpr (dim == 2)
    return {tangents[0][1], -tangents[0][0]};
  else
    return cross(tangents[0], tangents[1]);
}

/// The second-order facets of the boundary groups as in the mesh file, whatever becomes of the cells; none
/// for a mesh of order 1.
struct QuadraticFacets
{
  std::vector<int> tags{};  ///< per facet: position in MeshLabels::boundary_names
  /// Per facet n_facet_nodes: its vertices, ordered so that normal_of() its edges points out of the body,
  /// then the nodes on its local_edges.
  std::vector<Index> nodes{};
  std::vector<double> points{};  ///< dim coordinates per node
  FirstFacets first{};           ///< all facets of the groups by their vertices, of whatever order
};

/// The tagged facets of `boundary` whose edges all have a node, and all tagged ones as the first facets.
/// Throws InputError for a node that is not finite, and for an edge with two nodes.
template <int dim>
[[nodiscard]] std::shared_ptr<const QuadraticFacets> quadratic_facets(
    const MeshData<dim>& data, std::span<const BoundaryFacet> boundary);

/// The distance of the facets of the group `tag` from the straight ones with their vertices: at the middles
/// of edges, in 3D also of facets. 0 where it is within the rounding of the coordinates.
template <int dim>
[[nodiscard]] double sagitta(const QuadraticFacets& facets, int tag);

}  // namespace tribound::mesh
