#include "tribound/mesh/gmsh_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <span>

#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/import/simplex_nodes.h"

namespace tribound::mesh
{

int mesh_dimension(const Where& where)
{
  for (const int dim : {3, 2})
    if (!gmsh::element_types(dim).empty()) return dim;
  throw InputError(where, "the mesh has neither plane elements nor solids",
                   "a 2D problem needs a meshed surface, a 3D problem a meshed volume; put it into a "
                   "physical group if any "
                   "groups exist: Gmsh saves only what is in a group");
}

namespace
{

struct NumberedType
{
  int number;
  ElementType type;
};

constexpr std::array<NumberedType, 24> numbered_types = {
    {{1, {Shape::segment, 2}},        {8, {Shape::segment, 3}},       {26, {Shape::segment, 4}},
     {27, {Shape::segment, 5}},       {2, {Shape::triangle, 3}},      {9, {Shape::triangle, 6}},
     {21, {Shape::triangle, 10}},     {23, {Shape::triangle, 15}},    {3, {Shape::quadrilateral, 4}},
     {16, {Shape::quadrilateral, 8}}, {4, {Shape::tetrahedron, 4}},   {10, {Shape::quadrilateral, 9}},
     {11, {Shape::tetrahedron, 10}},  {29, {Shape::tetrahedron, 20}}, {30, {Shape::tetrahedron, 35}},
     {5, {Shape::hexahedron, 8}},     {17, {Shape::hexahedron, 20}},  {12, {Shape::hexahedron, 27}},
     {6, {Shape::prism, 6}},          {18, {Shape::prism, 15}},       {13, {Shape::prism, 18}},
     {7, {Shape::pyramid, 5}},        {19, {Shape::pyramid, 13}},     {14, {Shape::pyramid, 14}}}};

}  // namespace

std::optional<ElementType> gmsh_type(int number)
{
  const auto known = std::ranges::find(numbered_types, number, &NumberedType::number);
  if (known == numbered_types.end()) return {};
  return known->type;
}

namespace
{

using GmshEdges = std::initializer_list<std::array<int, 2>>;

/// The edges of solids in the order of Gmsh's middles; tetrahedra have an order of their own.
std::span<const std::array<int, 2>> gmsh_edges(Shape shape)
{
  static constexpr GmshEdges hexahedron = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3},
                                           {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  static constexpr GmshEdges prism = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}};
  static constexpr GmshEdges pyramid = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}};
  switch (shape)
  {
    case Shape::hexahedron:
      return hexahedron;
    case Shape::prism:
      return prism;
    case Shape::pyramid:
      return pyramid;
    default:
      return {};
  }
}

/// For each quadrilateral face of ShapeTable its number among the face centres of Gmsh.
std::span<const int> gmsh_face_centres(Shape shape)
{
  static constexpr std::initializer_list<int> hexahedron = {0, 5, 1, 3, 4, 2};
  static constexpr std::initializer_list<int> prism = {0, 2, 1};
  if (shape == Shape::hexahedron) return hexahedron;
  if (shape == Shape::prism) return prism;
  return {};
}

std::vector<int> order_in_tetrahedron(const ElementType& type)
{
  static constexpr std::array<std::array<int, 2>, 6> edges = {
      {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
  static constexpr std::array<std::array<int, 3>, 4> faces = {{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}}};
  const std::vector<NodeIndex> theirs = simplex_nodes(4, order_of(type), {edges, faces});
  std::vector<int> order;
  for (const NodeIndex& node : simplex_nodes(type))
    order.push_back(static_cast<int>(std::ranges::find(theirs, node) - theirs.begin()));
  return order;
}

/// Edges and triangles have the same order here and there.
std::vector<int> node_order(const ElementType& type)
{
  if (type.shape == Shape::tetrahedron) return order_in_tetrahedron(type);
  const ShapeTable& table = table_of(type.shape);
  std::vector<int> order(type.n_nodes);
  std::iota(order.begin(), order.end(), 0);
  if (!has_middles(type)) return order;
  int place = table.n_corners;
  for (const auto& [a, b] : gmsh_edges(type.shape))
    order[table.n_corners + edge_number(table, a, b)] = place++;
  const int first_centre = table.n_corners + table.n_edges;
  if (first_centre == type.n_nodes) return order;
  int face = first_centre;
  for (const int centre : gmsh_face_centres(type.shape)) order[face++] = first_centre + centre;
  return order;
}

}  // namespace

GmshType to_gmsh(const ElementType& type)
{
  const auto known = std::ranges::find(numbered_types, type, &NumberedType::type);
  return {known->number, type, node_order(type)};
}

namespace
{

/// Throws unless it is a type that is known.
NumberedType known_type(const Where& where, int number)
{
  if (const std::optional<ElementType> known = gmsh_type(number)) return {number, *known};
  const auto [name, order] = gmsh::element_properties(number);
  throw InputError(where, fmt::format("the mesh has elements that are not read ({}, order {})", name, order),
                   "triangles and tetrahedra of order 1 to 4; quadrilaterals, hexahedra, prisms and pyramids "
                   "of order 1 or 2; for cells with straight sides Mesh.ElementOrder = 1 or 2 is enough");
}

}  // namespace

// Gmsh reports the type of the first element of an entity for all elements of that shape. Reading nodes by
// type then overruns its arrays if an element with more nodes comes later, so each element is looked at
// first.
void check_elements(const Where& where, int mesh_dim)
{
  std::optional<NumberedType> first;
  const auto look = [&](int number, std::optional<int> reported)
  {
    const NumberedType found = known_type(where, number);
    if (!first) first = found;
    if (order_of(found.type) != order_of(first->type))
      throw InputError(where,
                       fmt::format("the mesh has elements of order {} and of order {}", order_of(first->type),
                                   order_of(found.type)),
                       "all cells and facets of one order: mesh again, with Mesh.ElementOrder = 1 or 2");
    if (reported && *reported != number)
      throw InputError(where,
                       fmt::format("one entity has elements of two kinds, {} and {}",
                                   describe(known_type(where, *reported).type), describe(found.type)),
                       "mesh again, with Mesh.SecondOrderIncomplete = 0 or 1 for all");
  };
  for (const int dim : {mesh_dim, mesh_dim - 1})
    for (const int type : gmsh::element_types(dim)) look(type, {});
  for (const int dim : {mesh_dim, mesh_dim - 1})
    for (const int type : gmsh::element_types(dim))
      for (const std::size_t element : gmsh::elements(type)) look(gmsh::element_type(element), type);
}

std::vector<GmshType> gmsh_types(const Where& where, int dim)
{
  std::vector<GmshType> types;
  for (const int number : gmsh::element_types(dim)) types.push_back(to_gmsh(known_type(where, number).type));
  return types;
}

}  // namespace tribound::mesh
