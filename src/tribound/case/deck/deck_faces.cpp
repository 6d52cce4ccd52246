#include "tribound/case/deck/deck_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tribound/base/sorted.h"
#include "tribound/mesh/import/node_sets.h"

namespace tribound::case_file
{

using mesh::ElementType;
using mesh::FaceNodes;
using mesh::Shape;

DeckFaces::DeckFaces(const mesh::ImportedMesh& mesh, bool is_axisymmetric)
    : mesh_(mesh),
      dim_(mesh::table_of(mesh.cells.at(0).type.shape).dim),
      is_axisymmetric_(is_axisymmetric),
      faces_(mesh::CellFaces(mesh.cells, std::vector<char>(mesh.nodes.size(), 1)).outer())
{
  for (const mesh::ElementBlock& block : mesh.cells) n_cells_ += static_cast<Index>(block.size());
  for (const Point<3>& x : mesh.nodes) size_ = std::max(size_, x.lpNorm<Eigen::Infinity>());
}

Index DeckFaces::find(const FaceNodes& face) const
{
  const mesh::FaceKey key = mesh::key_of(face.span().first(mesh::table_of(face.type.shape).n_corners));
  const auto found = std::ranges::lower_bound(faces_, key, {}, &mesh::CellFace::key);
  return found == faces_.end() || found->key != key ? -1 : static_cast<Index>(found - faces_.begin());
}

std::vector<Index> DeckFaces::with_all_nodes(std::span<const Index> nodes) const
{
  return with_all_nodes_of(std::array{nodes})[0];
}

std::vector<std::vector<Index>> DeckFaces::with_all_nodes_of(
    std::span<const std::span<const Index>> sets) const
{
  const mesh::SetsOfNodes sets_of_nodes(mesh_.nodes.size(), sets);
  std::vector<std::vector<Index>> result(sets.size());
  for (std::size_t f = 0; f < faces_.size(); ++f)
  {
    const FaceNodes face = nodes(static_cast<Index>(f));
    for (const Index set : sets_of_nodes.with_all(face.span())) result[set].push_back(static_cast<Index>(f));
  }
  return result;
}

std::vector<Index> DeckFaces::loaded_by(std::span<const Index> nodes) const
{
  std::vector<char> is_given(mesh_.nodes.size(), 0);
  for (const Index node : nodes) is_given[node] = 1;
  std::vector<Index> result;
  for (std::size_t f = 0; f < faces_.size(); ++f)
  {
    const FaceNodes face = this->nodes(static_cast<Index>(f));
    int n_carrying = 0;
    int n_given = 0;
    for (int i = 0; i < face.type.n_nodes; ++i)
    {
      if (!carries_load(face, i)) continue;
      ++n_carrying;
      n_given += is_given[face.nodes[i]];
    }
    if (n_carrying > 0 && n_given == n_carrying) result.push_back(static_cast<Index>(f));
  }
  return result;
}

/// Of a triangle of 6 nodes the middles alone do; of an edge of 3 nodes not the nodes on the axis, of one of
/// 2 nodes none if both are.
bool DeckFaces::carries_load(const FaceNodes& face, int node) const
{
  if (face.type == ElementType{Shape::triangle, 6}) return node >= 3;
  if (face.type == ElementType{Shape::segment, 3}) return !is_on_axis(face.nodes[node]);
  return std::ranges::any_of(face.span(), [&](Index v) { return !is_on_axis(v); });
}

bool DeckFaces::is_on_axis(Index node) const
{
  constexpr double rounding = 1e-10;
  return is_axisymmetric_ && std::abs(mesh_.nodes[node][0]) <= rounding * size_;
}

namespace
{

/// Values of the shape functions at (a, b): in [-1, 1]^2, in the unit triangle, or on [-1, 1].
std::vector<double> shape_functions(const ElementType& type, double a, double b)
{
  const auto linear = [](double x) { return std::array{(1 - x) / 2, (1 + x) / 2}; };
  const auto quadratic = [](double x) { return std::array{x * (x - 1) / 2, x * (x + 1) / 2, 1 - x * x}; };
  const double c = 1 - a - b;
  if (type.shape == Shape::segment)
  {
    if (type.n_nodes == 2) return {linear(a)[0], linear(a)[1]};
    return {quadratic(a)[0], quadratic(a)[1], quadratic(a)[2]};
  }
  if (type.shape == Shape::triangle)
  {
    if (type.n_nodes == 3) return {c, a, b};
    return {c * (2 * c - 1), a * (2 * a - 1), b * (2 * b - 1), 4 * c * a, 4 * a * b, 4 * b * c};
  }
  constexpr std::array<std::array<int, 2>, 9> place = {
      {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {1, 2}, {2, 1}, {0, 2}, {2, 2}}};
  std::vector<double> result;
  result.reserve(type.n_nodes);
  for (int i = 0; i < type.n_nodes; ++i)
    result.push_back(type.n_nodes == 4 ? linear(a)[place[i][0]] * linear(b)[place[i][1]]
                                       : quadratic(a)[place[i][0]] * quadratic(b)[place[i][1]]);
  if (type.n_nodes != 8) return result;
  // Without a node at the centre, whose function the others share.
  const double centre = (1 - a * a) * (1 - b * b);
  for (int i = 0; i < 8; ++i) result[i] += (i < 4 ? -0.25 : 0.5) * centre;
  return result;
}

}  // namespace

std::vector<double> DeckFaces::weights(Index face) const
{
  const FaceNodes nodes = this->nodes(face);
  constexpr std::array<double, 4> points = {-0.861136311594052575, -0.339981043584856265,
                                            0.339981043584856265, 0.861136311594052575};
  constexpr std::array<double, 4> gauss = {0.347854845137453857, 0.652145154862546143, 0.652145154862546143,
                                           0.347854845137453857};
  const auto x = [&](double a, double b)
  {
    const std::vector<double> values = shape_functions(nodes.type, a, b);
    Point<3> result = Point<3>::Zero();
    for (int i = 0; i < nodes.type.n_nodes; ++i) result += values[i] * mesh_.nodes[nodes.nodes[i]];
    return result;
  };
  std::vector<double> result(nodes.type.n_nodes, 0.0);
  const auto add = [&](double a, double b, double weight)
  {
    constexpr double h = 0.5;  // central differences of quadratic functions are exact
    const Point<3> along_a = (x(a + h, b) - x(a - h, b)) / (2 * h);
    const Point<3> along_b = (x(a, b + h) - x(a, b - h)) / (2 * h);
    const double area = nodes.type.shape == Shape::segment ? along_a.norm() : along_a.cross(along_b).norm();
    const std::vector<double> values = shape_functions(nodes.type, a, b);
    const double circle = is_axisymmetric_ ? 2 * std::numbers::pi * x(a, b)[0] : 1.0;
    for (int i = 0; i < nodes.type.n_nodes; ++i) result[i] += weight * circle * area * values[i];
  };
  for (int i = 0; i < 4; ++i)
    if (nodes.type.shape == Shape::segment)
      add(points[i], 0, gauss[i]);
    else
      for (int j = 0; j < 4; ++j)
        if (nodes.type.shape == Shape::quadrilateral)
          add(points[i], points[j], gauss[i] * gauss[j]);
        else  // the square collapsed to the triangle
          add((1 + points[i]) / 2, (1 - points[i]) * (1 + points[j]) / 4,
              gauss[i] * gauss[j] * (1 - points[i]) / 8);
  return result;
}

Point<3> DeckFaces::normal(Index face) const
{
  const FaceNodes nodes = this->nodes(face);
  const auto corner = [&](int i) -> const Point<3>& { return mesh_.nodes[nodes.nodes[i]]; };
  const Point<3> along = corner(1) - corner(0);
  const Point<3> normal = nodes.type.shape == Shape::segment ? Point<3>(along[1], -along[0], 0)
                          : nodes.type.shape == Shape::triangle
                              ? Point<3>(along.cross(corner(2) - corner(0)))
                              : (corner(2) - corner(0)).cross(corner(3) - corner(1));
  const auto cell = mesh_.cells[faces_[face].block].element(faces_[face].element);
  Point<3> centre = Point<3>::Zero();
  for (const Index node : cell) centre += mesh_.nodes[node] / static_cast<double>(cell.size());
  return (normal.dot(corner(0) - centre) > 0 ? normal : Point<3>(-normal)).normalized();
}

bool DeckFaces::is_curved(Index face) const
{
  constexpr double tolerance = 1e-6;
  const FaceNodes nodes = this->nodes(face);
  if (!mesh::has_middles(nodes.type)) return false;
  const mesh::ShapeTable& table = mesh::table_of(nodes.type.shape);
  const auto x = [&](int i) -> const Point<3>& { return mesh_.nodes[nodes.nodes[i]]; };
  const auto is_off = [&](int a, int b, int middle)
  { return (x(middle) - (x(a) + x(b)) / 2).norm() > tolerance * (x(b) - x(a)).norm(); };
  if (nodes.type.shape == Shape::segment) return is_off(0, 1, 2);
  for (int e = 0; e < table.n_edges; ++e)
    if (is_off(table.edges[e][0], table.edges[e][1], table.n_corners + e)) return true;
  return false;
}

std::vector<Index> DeckFaces::nodes_on(std::span<const Index> faces) const
{
  std::vector<Index> result;
  for (const Index face : faces)
  {
    const FaceNodes of_face = nodes(face);
    result.insert(result.end(), of_face.span().begin(), of_face.span().end());
  }
  sort_and_unite(result);
  return result;
}

std::vector<std::vector<Index>> DeckFaces::connected(std::span<const Index> faces) const
{
  std::map<Index, std::vector<Index>> faces_of_node;
  for (const Index face : faces)
  {
    const FaceNodes of_face = nodes(face);
    for (const Index node : of_face.span()) faces_of_node[node].push_back(face);
  }
  std::map<Index, bool> is_reached;
  std::vector<std::vector<Index>> result;
  for (const Index first : faces)
  {
    if (is_reached[first]) continue;
    std::vector<Index> part = {first};
    is_reached[first] = true;
    for (std::size_t k = 0; k < part.size(); ++k)
    {
      const FaceNodes of_face = nodes(part[k]);
      for (const Index node : of_face.span())
        for (const Index next : faces_of_node[node])
          if (!std::exchange(is_reached[next], true)) part.push_back(next);
    }
    std::ranges::sort(part);
    result.push_back(std::move(part));
  }
  return result;
}

std::vector<std::array<Point<3>, 3>> DeckFaces::triangles(Index face) const
{
  const FaceNodes nodes = this->nodes(face);
  const auto corner = [&](int i) -> const Point<3>& { return mesh_.nodes[nodes.nodes[i]]; };
  if (nodes.type.shape == Shape::segment) return {{corner(0), corner(1), corner(1)}};
  std::vector<std::array<Point<3>, 3>> result = {{corner(0), corner(1), corner(2)}};
  if (nodes.type.shape == Shape::quadrilateral) result.push_back({corner(0), corner(2), corner(3)});
  return result;
}

double distance(const Point<3>& x, const std::array<Point<3>, 3>& triangle)
{
  const auto& [a, b, c] = triangle;
  const Point<3> normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Point<3>& from, const Point<3>& to)
  { return (to - from).cross(x - from).dot(normal) >= 0; };
  if (normal.squaredNorm() > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return std::abs((x - a).dot(normal)) / normal.norm();
  const auto to_segment = [&](const Point<3>& from, const Point<3>& to)
  {
    const Point<3> along = to - from;
    const double square = along.squaredNorm();
    const double s = square > 0 ? std::clamp((x - from).dot(along) / square, 0.0, 1.0) : 0.0;
    return (x - from - s * along).norm();
  };
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

}  // namespace tribound::case_file
