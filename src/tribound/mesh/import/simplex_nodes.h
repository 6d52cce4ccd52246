#pragma once

/// @file simplex_nodes.h
/// The nodes of segments, triangles and tetrahedra of order 1 to 4.

#include <array>
#include <span>
#include <vector>

#include "tribound/mesh/import/element_type.h"

namespace tribound::mesh
{

/// Barycentric coordinates of a node times the order, which is their sum.
using NodeIndex = std::array<int, 4>;

/// The order of nodes: corners, then the nodes inside edges, each from its first corner to its second, then
/// those inside faces, each as the triangle of its corners, then those inside.
struct NodeOrder
{
  std::span<const std::array<int, 2>> edges;
  std::span<const std::array<int, 3>> faces;
};
[[nodiscard]] std::vector<NodeIndex> simplex_nodes(int n_corners, int order, const NodeOrder& by);

/// In the order of ElementType, which is that of VTK: edges as in ShapeTable, the faces of a tetrahedron as
/// in its vtkHigherOrderTetra.
[[nodiscard]] const std::vector<NodeIndex>& simplex_nodes(const ElementType& type);

/// The basis function of the node at a point with these barycentric coordinates.
[[nodiscard]] double shape_function(const NodeIndex& node, std::span<const double> lambda);

}  // namespace tribound::mesh
