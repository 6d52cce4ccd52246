#pragma once

/// @file marked_cell.h
/// Cells with marked edges, and how marks are inherited: the rules of Arnold, Mukherjee and Pouly [AMP00], in
/// 2D newest vertex bisection.
///
/// Every triangle of the mesh, in 3D every face of a tetrahedron, has a marked edge, the same from both
/// sides; the refinement edge of a tetrahedron is the one that is marked in both faces that contain it. At
/// first the longest edges are marked. A cell is cut at the middle of its refinement edge, and each child
/// refines next at the marked edge of the facet that it shares with its parent (in 2D, the facet itself).
/// Halves of a face and the new face are marked opposite to the new vertex, with one exception: where the
/// marked edges of the parent lie in one plane, and did so in its own parent, the new face is marked from the
/// new vertex to the vertex common to the refinement edges of the two children.

#include <cstdint>
#include <span>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// A cell, positively oriented, whose refinement edge joins the local vertices 0 and 1.
template <int dim>
struct MarkedCell
{
  Cell<dim> vertices;
  /// 0 in 2D. In 3D a + 3 b + 9 f: in the facets opposite to the local vertices 0 and 1, the marked edge is
  /// opposite to the facet's vertex number a, or b, in {0, 1, 2}. f = 1: the marked edges lie in one plane,
  /// and so did those of the parent; else 0.
  std::uint8_t type;
};

/// The number of bisection types.
template <int dim>
inline constexpr int n_bisection_types = dim == 2 ? 1 : 18;

/// The vertices of local facet `local`, its marked edge (in 2D the facet itself) first.
template <int dim>
[[nodiscard]] std::array<Index, dim> marked_facet(const MarkedCell<dim>& cell, int local);

/// The child that keeps the local vertex `kept`, 0 or 1; `middle`: the new vertex on the refinement edge.
template <int dim>
[[nodiscard]] MarkedCell<dim> child(const MarkedCell<dim>& parent, int kept, Index middle);

/// The cell with its longest edge and the longest edges of its faces marked. Edges of equal length are
/// ordered by the coordinates of their ends, so that the numbers of the vertices do not matter.
template <int dim>
[[nodiscard]] MarkedCell<dim> longest_edges_marked(std::span<const Point<dim>> points, const Cell<dim>& cell);

/// Cell c of `cells` as bisection continues with it: with the type that it has, or, where `types` is empty,
/// with its longest edges marked.
template <int dim>
[[nodiscard]] MarkedCell<dim> marked_cell(std::span<const Point<dim>> points,
                                          std::span<const Cell<dim>> cells,
                                          std::span<const std::uint8_t> types, Index c)
{
  if (types.empty()) return longest_edges_marked<dim>(points, cells[c]);
  return {cells[c], types[c]};
}

}  // namespace tribound::mesh
