#include "tribound/mesh/triangulated_surface.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

namespace tribound::mesh
{

namespace
{

std::string text(const Point<3>& x)
{
  return fmt::format("({:.6g})", fmt::join(x.data(), x.data() + 3, ", "));
}

/// The point of a triangle nearest to x by its barycentric coordinates (Ericson, Real-time collision
/// detection, 5.1.5): the regions of vertices and edges one after another, then the inside.
Point<3> nearest_in_triangle(const Point<3>& x, const Point<3>& a, const Point<3>& b, const Point<3>& c)
{
  const Point<3> ab = b - a;
  const Point<3> ac = c - a;
  const double d1 = ab.dot(x - a);
  const double d2 = ac.dot(x - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(x - b);
  const double d4 = ac.dot(x - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = ab.dot(x - c);
  const double d6 = ac.dot(x - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  const double along = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {0, 1 - (d4 - d3) / along, (d4 - d3) / along};
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

double angle_at(const Point<3>& a, const Point<3>& b, const Point<3>& c)
{
  return std::atan2((b - a).cross(c - a).norm(), (b - a).dot(c - a));
}

}  // namespace

TriangulatedSurface::TriangulatedSurface(std::span<const Point<3>> vertices,
                                         std::span<const Triangle> triangles, const Where& where)
{
  join(vertices, triangles);
  if (triangles_.empty()) throw InputError(where, "has no triangle", "a surface made of triangles");
  find_neighbours(where);
  turn_outward();
  find_normals();
  std::vector<BoundingBox<3>> boxes(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const Index v : triangles_[t]) boxes[t].add(vertices_[v]);
  tree_ = BoxTree<3>(boxes);
}

void TriangulatedSurface::join(std::span<const Point<3>> vertices, std::span<const Triangle> triangles)
{
  std::map<std::array<double, 3>, Index> numbers;
  std::vector<Index> number_of;
  for (const Point<3>& x : vertices)
  {
    const std::array<double, 3> key{x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};  // -0 is 0
    const auto [it, is_new] = numbers.try_emplace(key, static_cast<Index>(vertices_.size()));
    if (is_new) vertices_.push_back(x);
    number_of.push_back(it->second);
  }
  for (const Triangle& given : triangles)
  {
    Triangle t;
    for (int i = 0; i < 3; ++i) t[i] = number_of[given[i]];
    const Point<3> area = (vertices_[t[1]] - vertices_[t[0]]).cross(vertices_[t[2]] - vertices_[t[0]]);
    if (area.norm() > 0) triangles_.push_back(t);
  }
}

void TriangulatedSurface::find_neighbours(const Where& where)
{
  std::map<std::array<Index, 2>, std::pair<std::size_t, int>> waiting;  // by directed edge
  neighbours_.assign(triangles_.size(), {-1, -1, -1});
  std::size_t n_open = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int i = 0; i < 3; ++i)
    {
      const Index from = triangles_[t][(i + 1) % 3];
      const Index to = triangles_[t][(i + 2) % 3];
      if (!waiting.try_emplace({from, to}, t, i).second)
        throw InputError(where,
                         fmt::format("the triangles at the edge from {} to {} do not make a surface",
                                     text(vertices_[from]), text(vertices_[to])),
                         "an edge belongs to two triangles at most, whose normals point to the same side");
    }
  for (const auto& [edge, place] : waiting)
  {
    const auto other = waiting.find({edge[1], edge[0]});
    if (other == waiting.end())
      ++n_open;
    else
      neighbours_[place.first][place.second] = static_cast<Index>(other->second.first);
  }
  is_closed_ = n_open == 0;
}

double TriangulatedSurface::six_volumes(std::span<const Triangle> shell) const
{
  const Point<3>& apex = vertices_[shell[0][0]];
  double result = 0;
  for (const Triangle& t : shell)
    result += (vertices_[t[0]] - apex).dot((vertices_[t[1]] - apex).cross(vertices_[t[2]] - apex));
  return result;
}

std::vector<std::vector<TriangulatedSurface::Triangle>> TriangulatedSurface::shells() const
{
  std::vector<std::vector<Triangle>> result;
  std::vector<char> is_reached(triangles_.size(), 0);
  for (std::size_t first = 0; first < triangles_.size(); ++first)
  {
    if (std::exchange(is_reached[first], 1) != 0) continue;
    std::vector<Index> reached = {static_cast<Index>(first)};
    std::vector<Triangle>& shell = result.emplace_back();
    for (std::size_t k = 0; k < reached.size(); ++k)
    {
      shell.push_back(triangles_[reached[k]]);
      for (const Index next : neighbours_[reached[k]])
        if (next >= 0 && std::exchange(is_reached[next], 1) == 0) reached.push_back(next);
    }
  }
  return result;
}

std::size_t TriangulatedSurface::n_bodies() const
{
  const std::vector<std::vector<Triangle>> shells = this->shells();
  const auto largest = std::ranges::max_element(
      shells, {}, [&](const std::vector<Triangle>& shell) { return std::abs(six_volumes(shell)); });
  const TriangulatedSurface outer(vertices_, *largest, {});
  std::size_t result = 1;
  for (auto shell = shells.begin(); shell != shells.end(); ++shell)
    if (shell != largest && outer.nearest(vertices_[(*shell)[0][0]]).distance > 0) ++result;
  return result;
}

/// Decides by the sign of the volume.
void TriangulatedSurface::turn_outward()
{
  if (!is_closed_ || six_volumes(triangles_) >= 0) return;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
  {
    std::swap(triangles_[t][1], triangles_[t][2]);
    std::swap(neighbours_[t][1], neighbours_[t][2]);
  }
}

void TriangulatedSurface::find_normals()
{
  vertex_normals_.assign(vertices_.size(), Point<3>::Zero());
  for (const Triangle& t : triangles_)
  {
    const Point<3> n =
        (vertices_[t[1]] - vertices_[t[0]]).cross(vertices_[t[2]] - vertices_[t[0]]).normalized();
    normals_.push_back(n);
    for (int i = 0; i < 3; ++i)
      vertex_normals_[t[i]] +=
          angle_at(vertices_[t[i]], vertices_[t[(i + 1) % 3]], vertices_[t[(i + 2) % 3]]) * n;
  }
  for (Point<3>& n : vertex_normals_)
    if (n.norm() > 0) n.normalize();
  edge_normals_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int i = 0; i < 3; ++i)
    {
      const Index other = neighbours_[t][i];
      edge_normals_[t][i] = other < 0 ? normals_[t] : Point<3>(normals_[t] + normals_[other]);
    }
}

auto TriangulatedSurface::nearest(const Point<3>& x) const -> Nearest
{
  double best = std::numeric_limits<double>::infinity();
  std::size_t triangle = 0;
  Point<3> lambda = Point<3>::Zero();
  Point<3> point = Point<3>::Zero();
  tree_.traverse([&](const BoundingBox<3>& box) { return square_distance(box, x) < best; },
                 [&](std::size_t t)
                 {
                   const auto& [a, b, c] = triangles_[t];
                   const Point<3> here = nearest_in_triangle(x, vertices_[a], vertices_[b], vertices_[c]);
                   const Point<3> y =
                       here[0] * vertices_[a] + here[1] * vertices_[b] + here[2] * vertices_[c];
                   const double square = (y - x).squaredNorm();
                   // Of equally near ones the first, however the tree is traversed.
                   if (square > best || (square == best && t > triangle)) return;
                   best = square;
                   triangle = t;
                   lambda = here;
                   point = y;
                 });
  const Triangle& t = triangles_[triangle];
  Point<3> pseudonormal = normals_[triangle];
  const auto n_zero = std::ranges::count(std::array{lambda[0], lambda[1], lambda[2]}, 0.0);
  for (int i = 0; i < 3; ++i)
  {
    if (n_zero == 2 && lambda[i] != 0) pseudonormal = vertex_normals_[t[i]];
    if (n_zero == 1 && lambda[i] == 0) pseudonormal = edge_normals_[triangle][i];
  }
  Point<3> normal = Point<3>::Zero();
  for (int i = 0; i < 3; ++i) normal += lambda[i] * vertex_normals_[t[i]];
  if (normal.norm() == 0) normal = normals_[triangle];
  const double sign = (x - point).dot(pseudonormal) < 0 ? -1 : 1;
  return {point, sign * std::sqrt(best), normal.normalized()};
}

namespace
{

constexpr std::size_t header = 84;
constexpr std::size_t record = 50;

std::vector<Point<3>> binary_corners(std::string_view bytes)
{
  std::vector<Point<3>> corners;
  for (std::size_t at = header; at + record <= bytes.size(); at += record)
    for (std::size_t i = 1; i <= 3; ++i)  // behind the normal, which follows from them
    {
      std::array<float, 3> x;
      std::memcpy(x.data(), bytes.data() + at + i * sizeof(x), sizeof(x));
      corners.emplace_back(x[0], x[1], x[2]);
    }
  return corners;
}

/// Empty if it is not an ASCII file.
std::vector<Point<3>> ascii_corners(const std::string& bytes)
{
  std::istringstream stream(bytes);
  std::vector<Point<3>> corners;
  std::string word;
  if (!(stream >> word) || word != "solid") return {};
  while (stream >> word)
  {
    if (word != "vertex") continue;
    Point<3> x;
    for (double& coordinate : x)
      if (!(stream >> coordinate)) return {};
    corners.push_back(x);
  }
  return corners;
}

}  // namespace

TriangulatedSurface read_stl(const std::filesystem::path& file, const Where& where)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError(where, fmt::format("{} cannot be read", file.string()),
                     "the path of an STL file; a relative one is relative to the folder of the case file");
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::uint32_t n = 0;
  if (bytes.size() >= header) std::memcpy(&n, bytes.data() + header - sizeof(n), sizeof(n));
  const bool is_binary = bytes.size() >= header && bytes.size() == header + record * std::size_t{n};
  const std::vector<Point<3>> corners = is_binary ? binary_corners(bytes) : ascii_corners(bytes);
  if (corners.empty() || corners.size() % 3 != 0)
    throw InputError(where, fmt::format("{} is no STL file with triangles", file.string()),
                     "an STL file, ASCII or binary");
  for (const Point<3>& x : corners)
    if (!x.allFinite())
      throw InputError(where, fmt::format("{} has a vertex that is not finite", file.string()),
                       "numbers as coordinates");
  std::vector<TriangulatedSurface::Triangle> triangles;
  for (Index i = 0; i < static_cast<Index>(corners.size()); i += 3) triangles.push_back({i, i + 1, i + 2});
  return {corners, triangles, where};
}

}  // namespace tribound::mesh
