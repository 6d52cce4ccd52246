#include "tribound/io/fields/vtk_nodes.h"

#include <cassert>
#include <span>

namespace tribound::io
{

namespace
{

using Pair = std::array<int, 2>;
using Triple = std::array<int, 3>;

// The sub-simplices in the order and orientation in which VTK visits them.
constexpr std::array<Pair, 3> triangle_edges{{{0, 1}, {1, 2}, {2, 0}}};
constexpr std::array<Pair, 6> tetrahedron_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<Triple, 4> tetrahedron_faces{{{0, 1, 3}, {2, 3, 1}, {0, 3, 2}, {0, 2, 1}}};

template <int k>
class NodeList
{
 public:
  using Node = std::array<int, k + 1>;

  explicit NodeList(int degree)
  {
    if constexpr (k == 1) append_edge({}, {0, 1}, degree, true);
    if constexpr (k == 2) append_triangle({}, {0, 1, 2}, degree);
    if constexpr (k == 3) append_tetrahedron({}, degree);
  }

  [[nodiscard]] std::vector<Node> take() && { return std::move(nodes_); }

 private:
  /// `base` moved by `weight` towards the given vertices.
  static Node moved(Node base, std::span<const int> vertices, int weight)
  {
    for (const int v : vertices) base[v] += weight;
    return base;
  }

  void append_corners(const Node& base, std::span<const int> vertices, int degree)
  {
    for (const int v : vertices) nodes_.push_back(moved(base, std::array{v}, degree));
  }

  void append_edge(const Node& base, const Pair& vertices, int degree, bool with_corners = false)
  {
    if (with_corners) append_corners(base, vertices, degree);
    for (int j = 1; j < degree; ++j)
    {
      Node node = base;
      node[vertices[0]] += degree - j;
      node[vertices[1]] += j;
      nodes_.push_back(node);
    }
  }

  /// All nodes of a triangle; its inner nodes are a triangle of degree - 3.
  void append_triangle(const Node& base, const Triple& vertices, int degree)
  {
    if (degree == 0) nodes_.push_back(base);
    if (degree <= 0) return;
    append_corners(base, vertices, degree);
    for (const auto& [a, b] : triangle_edges) append_edge(base, {vertices[a], vertices[b]}, degree);
    append_triangle(moved(base, vertices, 1), vertices, degree - 3);
  }

  /// All nodes of a tetrahedron; its inner nodes are a tetrahedron of degree - 4.
  void append_tetrahedron(const Node& base, int degree)
  {
    constexpr std::array vertices{0, 1, 2, 3};
    if (degree == 0) nodes_.push_back(base);
    if (degree <= 0) return;
    append_corners(base, vertices, degree);
    for (const Pair& edge : tetrahedron_edges) append_edge(base, edge, degree);
    for (const Triple& face : tetrahedron_faces) append_triangle(moved(base, face, 1), face, degree - 3);
    append_tetrahedron(moved(base, vertices, 1), degree - 4);
  }

  std::vector<Node> nodes_;
};

}  // namespace

template <int k>
std::vector<std::array<int, k + 1>> vtk_nodes(int degree)
{
  return NodeList<k>(degree).take();
}

template <int k>
std::vector<Point<k>> vtk_points(int degree)
{
  std::vector<Point<k>> points;
  for (const auto& node : vtk_nodes<k>(degree))
  {
    Point<k> x;
    for (int i = 0; i < k; ++i) x[i] = static_cast<double>(node[i + 1]) / degree;
    points.push_back(x);
  }
  return points;
}

template <int k>
std::vector<int> vtk_order(const fem::LagrangeBasis<k>& basis)
{
  std::vector<int> order;
  for (const auto& node : vtk_nodes<k>(basis.degree()))
  {
    int i = 0;
    while (i < basis.n_nodes() && basis.node(i) != node) ++i;
    assert(i < basis.n_nodes());  // both have the same nodes
    order.push_back(i);
  }
  return order;
}

template std::vector<std::array<int, 2>> vtk_nodes<1>(int);
template std::vector<std::array<int, 3>> vtk_nodes<2>(int);
template std::vector<std::array<int, 4>> vtk_nodes<3>(int);
template std::vector<Point<1>> vtk_points<1>(int);
template std::vector<Point<2>> vtk_points<2>(int);
template std::vector<Point<3>> vtk_points<3>(int);
template std::vector<int> vtk_order(const fem::LagrangeBasis<1>&);
template std::vector<int> vtk_order(const fem::LagrangeBasis<2>&);
template std::vector<int> vtk_order(const fem::LagrangeBasis<3>&);

}  // namespace tribound::io
