#pragma once

/// @file element_type.h
/// The elements of meshes that users bring: corners, edges, faces and the order of their nodes.

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace tribound::mesh
{

enum class Shape : char
{
  segment,
  triangle,
  quadrilateral,
  tetrahedron,
  hexahedron,
  prism,
  pyramid
};

/// The nodes are the corners; of second order the middles of the edges; then the centres of the
/// quadrilateral faces, and of a hexahedron and a quadrilateral its own. Corners, edges and faces are
/// numbered as in Abaqus, CalculiX and VTK. Simplices of higher order: simplex_nodes.h.
struct ElementType
{
  Shape shape;
  int n_nodes;

  [[nodiscard]] bool operator==(const ElementType&) const = default;
};

/// A face of a solid, or an edge of a plane element. Around it the corners run so that its normal points
/// inwards; an edge of a plane element has the element on its left.
struct FaceCorners
{
  int n;
  std::array<int, 4> corners;

  [[nodiscard]] std::span<const int> span() const { return std::span(corners).first(n); }
};

struct ShapeTable
{
  std::string_view name;
  int dim;
  int n_corners;
  int n_edges;
  std::array<std::array<int, 2>, 12> edges;
  int n_faces;
  std::array<FaceCorners, 6> faces;
  std::array<int, 4> n_nodes;  ///< of the types, linear first; 0: there are no more
};

[[nodiscard]] const ShapeTable& table_of(Shape shape);

/// Segments, triangles and tetrahedra.
[[nodiscard]] inline bool is_simplex(Shape shape)
{
  const ShapeTable& table = table_of(shape);
  return table.n_corners == table.dim + 1;
}

/// Of simplices; that of other shapes is at most 2.
inline constexpr int max_order = 4;

/// The order of the element; 0: there is no such element.
[[nodiscard]] int order_of(const ElementType& type);

/// Whether it has a node in the middle of each edge, and no other nodes on edges but corners.
[[nodiscard]] inline bool has_middles(const ElementType& type)
{
  return order_of(type) == 2;
}

/// "hexahedron of 20 nodes".
[[nodiscard]] std::string describe(const ElementType& type);

/// The place of the edge in ShapeTable::edges, whatever its direction; -1 if there is none.
[[nodiscard]] int edge_number(const ShapeTable& table, int a, int b);

inline constexpr int max_face_nodes = 15;  ///< of a triangle of order 4

/// A face as an element of its own.
struct FaceElement
{
  ElementType type;
  std::array<int, max_face_nodes>
      nodes;  ///< places among the nodes of the cell; the first type.n_nodes count

  [[nodiscard]] std::span<const int> span() const& { return std::span(nodes).first(type.n_nodes); }
  void span() const&& = delete;  ///< would outlive the nodes
};

[[nodiscard]] FaceElement face_element(const ElementType& type, int face);

}  // namespace tribound::mesh
