#include "tribound/mesh/import/simplex_nodes.h"

#include <cassert>
#include <numeric>

namespace tribound::mesh
{

namespace
{

constexpr std::array<std::array<int, 3>, 1> triangle = {{{0, 1, 2}}};
constexpr std::array<std::array<int, 3>, 4> vtk_faces = {{{0, 1, 3}, {2, 3, 1}, {0, 3, 2}, {0, 2, 1}}};

std::vector<NodeIndex> vtk_nodes(Shape shape, int order)
{
  const ShapeTable& table = table_of(shape);
  const auto edges = std::span(table.edges).first(table.n_edges);
  if (table.dim == 3) return simplex_nodes(table.n_corners, order, {edges, vtk_faces});
  if (table.dim == 2) return simplex_nodes(table.n_corners, order, {edges, triangle});
  return simplex_nodes(table.n_corners, order, {edges, {}});
}

using Orders = std::array<std::vector<NodeIndex>, max_order>;

Orders all_orders(Shape shape)
{
  Orders orders;
  for (int order = 1; order <= max_order; ++order) orders[order - 1] = vtk_nodes(shape, order);
  return orders;
}

}  // namespace

std::vector<NodeIndex> simplex_nodes(int n_corners, int order, const NodeOrder& by)
{
  std::vector<NodeIndex> nodes;
  for (int corner = 0; corner < n_corners; ++corner) nodes.emplace_back()[corner] = order;
  for (const auto& [a, b] : by.edges)
    for (int i = 1; i < order; ++i)
    {
      NodeIndex& node = nodes.emplace_back();
      node[a] = order - i;
      node[b] = i;
    }
  // Up to order 4 the nodes inside a face are one, or the corners of a triangle; inside a tetrahedron is one.
  for (const std::array<int, 3>& face : by.faces)
    for (int i = 0; i < (order < 3 ? 0 : order == 3 ? 1 : 3); ++i)
    {
      NodeIndex& node = nodes.emplace_back();
      for (const int corner : face) node[corner] = 1;
      node[face[i]] += order - 3;
    }
  if (n_corners == 4 && order == 4) nodes.push_back({1, 1, 1, 1});
  return nodes;
}

const std::vector<NodeIndex>& simplex_nodes(const ElementType& type)
{
  static const Orders segments = all_orders(Shape::segment);
  static const Orders triangles = all_orders(Shape::triangle);
  static const Orders tetrahedra = all_orders(Shape::tetrahedron);
  assert(is_simplex(type.shape) && order_of(type) > 0);
  const Orders& orders = type.shape == Shape::segment    ? segments
                         : type.shape == Shape::triangle ? triangles
                                                         : tetrahedra;
  return orders[order_of(type) - 1];
}

double shape_function(const NodeIndex& node, std::span<const double> lambda)
{
  const int order = std::accumulate(node.begin(), node.end(), 0);
  double value = 1;
  for (std::size_t corner = 0; corner < lambda.size(); ++corner)
    for (int k = 0; k < node[corner]; ++k) value *= (order * lambda[corner] - k) / (k + 1);
  return value;
}

}  // namespace tribound::mesh
