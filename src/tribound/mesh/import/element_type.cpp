#include "tribound/mesh/import/element_type.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tribound/mesh/import/simplex_nodes.h"

namespace tribound::mesh
{

namespace
{

constexpr std::array<ShapeTable, 7> shape_tables = {{
    {"segment", 1, 2, 1, {{{0, 1}}}, 0, {}, {2, 3, 4, 5}},
    {"triangle",
     2,
     3,
     3,
     {{{0, 1}, {1, 2}, {2, 0}}},
     3,
     {{{2, {0, 1}}, {2, {1, 2}}, {2, {2, 0}}}},
     {3, 6, 10, 15}},
    {"quadrilateral",
     2,
     4,
     4,
     {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
     4,
     {{{2, {0, 1}}, {2, {1, 2}}, {2, {2, 3}}, {2, {3, 0}}}},
     {4, 8, 9, 0}},
    {"tetrahedron",
     3,
     4,
     6,
     {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
     4,
     {{{3, {0, 1, 2}}, {3, {0, 3, 1}}, {3, {1, 3, 2}}, {3, {2, 3, 0}}}},
     {4, 10, 20, 35}},
    {"hexahedron",
     3,
     8,
     12,
     {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}},
     6,
     {{{4, {0, 1, 2, 3}},
       {4, {4, 7, 6, 5}},
       {4, {0, 4, 5, 1}},
       {4, {1, 5, 6, 2}},
       {4, {2, 6, 7, 3}},
       {4, {3, 7, 4, 0}}}},
     {8, 20, 27, 0}},
    {"prism",
     3,
     6,
     9,
     {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
     5,
     {{{3, {0, 1, 2}}, {3, {3, 5, 4}}, {4, {0, 3, 4, 1}}, {4, {1, 4, 5, 2}}, {4, {2, 5, 3, 0}}}},
     {6, 15, 18, 0}},
    {"pyramid",
     3,
     5,
     8,
     {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
     5,
     {{{4, {0, 1, 2, 3}}, {3, {0, 4, 1}}, {3, {1, 4, 2}}, {3, {2, 4, 3}}, {3, {3, 4, 0}}}},
     {5, 13, 14, 0}},
}};

/// The place of the centre of a quadrilateral face among the nodes; -1: the type has none.
int centre_of_face(const ElementType& type, int face)
{
  const ShapeTable& table = table_of(type.shape);
  if (table.dim < 3 || type.n_nodes <= table.n_corners + table.n_edges || table.faces[face].n < 4) return -1;
  int place = table.n_corners + table.n_edges;
  for (int f = 0; f < face; ++f) place += table.faces[f].n == 4 ? 1 : 0;
  return place;
}

/// The nodes of a face of a simplex, found by the corners of the cell between which they lie.
void add_simplex_nodes(const ElementType& type, const FaceCorners& corners, FaceElement& face)
{
  const std::vector<NodeIndex>& nodes = simplex_nodes(type);
  face.type.n_nodes = table_of(face.type.shape).n_nodes[order_of(type) - 1];
  const std::vector<NodeIndex>& of_face = simplex_nodes(face.type);
  for (std::size_t i = 0; i < of_face.size(); ++i)
  {
    NodeIndex node{};
    for (int corner = 0; corner < corners.n; ++corner) node[corners.corners[corner]] = of_face[i][corner];
    face.nodes[i] = static_cast<int>(std::ranges::find(nodes, node) - nodes.begin());
  }
}

}  // namespace

const ShapeTable& table_of(Shape shape)
{
  return shape_tables[static_cast<std::size_t>(shape)];
}

int order_of(const ElementType& type)
{
  const auto& known = table_of(type.shape).n_nodes;
  const auto place = std::ranges::find(known, type.n_nodes) - known.begin();
  if (place == std::ssize(known) || type.n_nodes == 0) return 0;
  return static_cast<int>(is_simplex(type.shape) || place == 0 ? place + 1 : 2);
}

std::string describe(const ElementType& type)
{
  return fmt::format("{} of {} nodes", table_of(type.shape).name, type.n_nodes);
}

int edge_number(const ShapeTable& table, int a, int b)
{
  for (int e = 0; e < table.n_edges; ++e)
    if (table.edges[e] == std::array{a, b} || table.edges[e] == std::array{b, a}) return e;
  return -1;
}

FaceElement face_element(const ElementType& type, int face)
{
  const ShapeTable& table = table_of(type.shape);
  const FaceCorners& corners = table.faces[face];
  const int n = corners.n;
  FaceElement result{{n == 2 ? Shape::segment : n == 3 ? Shape::triangle : Shape::quadrilateral, n}, {}};
  if (is_simplex(type.shape))
  {
    add_simplex_nodes(type, corners, result);
    return result;
  }
  std::copy_n(corners.corners.begin(), n, result.nodes.begin());
  if (!has_middles(type)) return result;
  const int n_edges = table_of(result.type.shape).n_edges;
  for (int e = 0; e < n_edges; ++e)
    result.nodes[n + e] =
        table.n_corners + edge_number(table, corners.corners[e], corners.corners[(e + 1) % n]);
  result.type.n_nodes = n + n_edges;
  if (const int centre = centre_of_face(type, face); centre >= 0)
    result.nodes[result.type.n_nodes++] = centre;
  return result;
}

}  // namespace tribound::mesh
