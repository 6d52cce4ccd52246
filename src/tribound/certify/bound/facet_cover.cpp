#include "tribound/certify/bound/facet_cover.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tribound/contact/pairing/polygon.h"

namespace tribound::certify
{

namespace
{

constexpr double rounding = 1e-11;  ///< in the coordinates of the reference facet
constexpr double smallest = 1e-14;  ///< area of a polygon over that of the facet

double cross(const Point<2>& a, const Point<2>& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// (b - a) x (c - a).
double turn(const Point<2>& a, const Point<2>& b, const Point<2>& c)
{
  return cross(b - a, c - a);
}

/// Convex, anticlockwise.
struct Piece
{
  std::vector<Point<2>> corners;
  int part;
};

/// By vertex numbers, including the vertices on its edges.
struct Loop
{
  std::vector<int> corners;
  int part;
};

using Edges = std::set<std::pair<int, int>>;  ///< directed, with the piece on the left

class Triangulation
{
 public:
  /// Makes the loops of the pieces, with the vertices of all of them. False if two pieces lie on the same
  /// side of an edge.
  [[nodiscard]] bool make_loops(std::span<const Piece> pieces)
  {
    vertices_.clear();
    loops_.clear();
    for (const Piece& piece : pieces)
    {
      Loop& loop = loops_.emplace_back(Loop{{}, piece.part});
      for (const Point<2>& x : piece.corners)
        if (const int v = vertex(x); std::ranges::find(loop.corners, v) == loop.corners.end())
          loop.corners.push_back(v);
    }
    for (Loop& loop : loops_) insert_vertices(loop);
    // a piece whose area is only rounding has a corner on the opposite edge: its sides coincide
    std::erase_if(loops_,
                  [](const Loop& loop)
                  {
                    std::vector<int> sorted = loop.corners;
                    std::ranges::sort(sorted);
                    return sorted.size() < 3 || std::ranges::adjacent_find(sorted) != sorted.end();
                  });
    edges_.clear();
    for (const Loop& loop : loops_)
      for (std::size_t i = 0; i < loop.corners.size(); ++i)
        if (!edges_.emplace(loop.corners[i], loop.corners[(i + 1) % loop.corners.size()]).second)
          return false;
    return true;
  }

  /// Calls visit(a, b) for the end points of the inner edges that have a piece on one side only.
  template <class Visit>
  void for_each_open_edge(const Visit& visit) const
  {
    for (const auto& [a, b] : edges_)
      if (!edges_.contains({b, a}) && !on_rim(vertices_[a], vertices_[b])) visit(vertices_[a], vertices_[b]);
  }

  /// Convex loops with more than three corners are divided from their centres.
  [[nodiscard]] FacetCover triangles() const
  {
    FacetCover cover{vertices_, {}};
    for (const auto& [corners, part] : loops_)
    {
      if (corners.size() == 3)
      {
        cover.triangles.push_back({{corners[0], corners[1], corners[2]}, part});
        continue;
      }
      Point<2> centre = Point<2>::Zero();
      for (const int v : corners) centre += vertices_[v] / static_cast<double>(corners.size());
      const int number = static_cast<int>(cover.vertices.size());
      cover.vertices.push_back(centre);
      for (std::size_t i = 0; i < corners.size(); ++i)
        cover.triangles.push_back({{number, corners[i], corners[(i + 1) % corners.size()]}, part});
    }
    return cover;
  }

 private:
  int vertex(const Point<2>& x)
  {
    const auto found = std::ranges::find_if(
        vertices_, [&](const Point<2>& other) { return (other - x).squaredNorm() < rounding * rounding; });
    if (found == vertices_.end())
    {
      vertices_.push_back(x);
      return static_cast<int>(vertices_.size()) - 1;
    }
    return static_cast<int>(found - vertices_.begin());
  }

  void insert_vertices(Loop& loop) const
  {
    std::vector<int> all;
    std::vector<std::pair<double, int>> between;
    for (std::size_t i = 0; i < loop.corners.size(); ++i)
    {
      const int a = loop.corners[i];
      const int b = loop.corners[(i + 1) % loop.corners.size()];
      const Point<2> edge = vertices_[b] - vertices_[a];
      const double length = edge.norm();
      between.clear();
      for (int v = 0; v < static_cast<int>(vertices_.size()); ++v)
      {
        const Point<2> from_a = vertices_[v] - vertices_[a];
        const double along = from_a.dot(edge) / length;
        if (v != a && v != b && along > 0 && along < length &&
            std::abs(cross(edge, from_a)) < rounding * length)
          between.emplace_back(along, v);
      }
      std::ranges::sort(between);
      all.push_back(a);
      for (const auto& [along, v] : between) all.push_back(v);
    }
    loop.corners = std::move(all);
  }

  static bool on_rim(const Point<2>& a, const Point<2>& b)
  {
    const auto both = [&](const auto& distance)
    { return std::abs(distance(a)) < rounding && std::abs(distance(b)) < rounding; };
    return both([](const Point<2>& x) { return x[0]; }) || both([](const Point<2>& x) { return x[1]; }) ||
           both([](const Point<2>& x) { return 1 - x[0] - x[1]; });
  }

  std::vector<Point<2>> vertices_;
  std::vector<Loop> loops_;
  Edges edges_;
};

/// Up to rounding: x may lie between two pieces.
bool contains(const Piece& piece, const Point<2>& x)
{
  for (std::size_t i = 0; i < piece.corners.size(); ++i)
    if (turn(piece.corners[i], piece.corners[(i + 1) % piece.corners.size()], x) < -rounding) return false;
  return true;
}

/// The part of the facet that the pieces leave uncovered. Their open edges bound it. Cutting the facet along
/// the lines through these edges gives polygons that are either covered or not.
std::vector<Piece> uncovered(const Triangulation& triangulation, std::span<const Piece> pieces)
{
  contact::Polygon<3> facet;
  for (const Point<2>& x : fem::reference_simplex<2>()) facet.push_back({x, x});
  std::vector<contact::Polygon<3>> polygons = {facet};
  triangulation.for_each_open_edge(
      [&](const Point<2>& a, const Point<2>& b)
      {
        const auto distance = [&](const contact::CornerPair<3>& x)
        { return turn(a, b, x.slave) / (b - a).norm(); };
        std::vector<contact::Polygon<3>> cut;
        for (const contact::Polygon<3>& polygon : polygons)
          for (const double side : {1, -1})
          {
            auto half = contact::clip<3>(polygon, [&](const auto& x) { return side * distance(x); });
            if (!half.empty() && contact::fraction<3>(half) > smallest) cut.push_back(std::move(half));
          }
        polygons = std::move(cut);
      });
  std::vector<Piece> result;
  for (const contact::Polygon<3>& polygon : polygons)
  {
    const Point<2> inside = contact::centroid<3>(polygon);
    if (std::ranges::any_of(pieces, [&](const Piece& piece) { return contains(piece, inside); })) continue;
    Piece& rest = result.emplace_back(Piece{{}, -1});
    for (const contact::CornerPair<3>& corner : polygon) rest.corners.push_back(corner.slave);
  }
  return result;
}

bool covers(const FacetCover& cover)
{
  double sum = 0;
  for (const FacetCover::Triangle& triangle : cover.triangles)
  {
    const auto& [a, b, c] = triangle.corners;
    const double area = turn(cover.vertices[a], cover.vertices[b], cover.vertices[c]);
    if (!(area > 0)) return false;
    sum += area;
  }
  return std::abs(sum - 1) < 10 * rounding;
}

}  // namespace

std::optional<FacetCover> conforming_cover(std::span<const fem::Part<2>> parts)
{
  std::vector<Piece> pieces;
  for (const fem::Part<2>& part : parts)
  {
    Piece& piece = pieces.emplace_back(Piece{{part[0], part[1], part[2]}, static_cast<int>(pieces.size())});
    if (turn(part[0], part[1], part[2]) < 0) std::swap(piece.corners[1], piece.corners[2]);
  }
  Triangulation triangulation;
  if (!triangulation.make_loops(pieces)) return {};
  if (std::vector<Piece> rest = uncovered(triangulation, pieces); !rest.empty())
  {
    pieces.insert(pieces.end(), rest.begin(), rest.end());
    if (!triangulation.make_loops(pieces)) return {};
  }
  bool is_closed = true;
  triangulation.for_each_open_edge([&](const Point<2>&, const Point<2>&) { is_closed = false; });
  if (!is_closed) return {};
  FacetCover cover = triangulation.triangles();
  if (!covers(cover)) return {};
  return cover;
}

}  // namespace tribound::certify
