#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tribound/base/sorted.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/outer_facets.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

/// Boxes of facets, hashed into grids. A facet is in the grid of spacing size / 2^level next above its
/// diameter, in the few grid cells that its bounding box meets. A point looks into one cell per level in use.
template <int dim>
class FacetSearch
{
 public:
  explicit FacetSearch(std::span<const OuterFacet<dim>> facets)
  {
    BoundingBox<dim> box;
    for (const auto& facet : facets)
      for (const auto& x : facet.points) box.add(x);
    lower_ = box.lower;
    size_ = box.longest_edge();

    std::size_t n_buckets = 1;
    while (n_buckets < 2 * facets.size()) n_buckets *= 2;
    begin_.assign(n_buckets + 1, 0);
    for (const auto& facet : facets) for_each_bucket(facet, [&](std::size_t b) { ++begin_[b + 1]; });
    for (std::size_t b = 0; b < n_buckets; ++b) begin_[b + 1] += begin_[b];
    entries_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t f = 0; f < facets.size(); ++f)
      for_each_bucket(facets[f], [&](std::size_t b) { entries_[next[b]++] = static_cast<Index>(f); });
    for (int level = 0; level < n_levels; ++level)
      if (used_[level]) levels_.push_back(level);
  }

  /// Calls visit(f) for a superset of the facets near x.
  template <class Visit>
  void near(const Point<dim>& x, const Visit& visit) const
  {
    for (const int level : levels_)
    {
      const std::size_t b = bucket(level, grid_cell(level, x));
      for (std::size_t k = begin_[b]; k < begin_[b + 1]; ++k) visit(entries_[k]);
    }
  }

 private:
  using GridCell = std::array<std::int64_t, dim>;
  static constexpr int n_levels = 48;

  GridCell grid_cell(int level, const Point<dim>& x) const
  {
    GridCell cell;
    for (int i = 0; i < dim; ++i)
      cell[i] = static_cast<std::int64_t>(std::floor(std::ldexp((x[i] - lower_[i]) / size_, level)));
    return cell;
  }

  std::size_t bucket(int level, const GridCell& cell) const
  {
    auto hash = static_cast<std::uint64_t>(level);
    for (const std::int64_t i : cell)
    {
      hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return hash & (begin_.size() - 2);
  }

  template <class Visit>
  void for_each_bucket(const OuterFacet<dim>& facet, const Visit& visit)
  {
    const int level = std::clamp(std::ilogb(size_ / facet.diameter), 0, n_levels - 1);
    used_[level] = true;
    const BoundingBox<dim> box = bounding_box<dim>(facet.points);
    const auto margin = Point<dim>::Constant(2 * coincidence * facet.diameter);
    const GridCell first = grid_cell(level, box.lower - margin);
    const GridCell last = grid_cell(level, box.upper + margin);
    for (GridCell cell = first;;)
    {
      visit(bucket(level, cell));
      int i = 0;
      while (i < dim && cell[i] == last[i])
      {
        cell[i] = first[i];
        ++i;
      }
      if (i == dim) return;
      ++cell[i];
    }
  }

  Point<dim> lower_;
  double size_ = 0.0;
  std::vector<std::size_t> begin_;
  std::vector<Index> entries_;
  std::array<bool, n_levels> used_{};
  std::vector<int> levels_;
};

/// Whether x lies on the facet, its ends included.
template <int dim>
bool lies_on(const Point<dim>& x, const OuterFacet<dim>& facet)
{
  const double tolerance = coincidence * facet.diameter;
  const Point<dim> d = x - facet.points[0];
  const Point<dim> a = facet.points[1] - facet.points[0];
  if constexpr (dim == 2)
  {
    const double t = std::clamp(d.dot(a) / a.squaredNorm(), 0.0, 1.0);
    return (d - t * a).squaredNorm() <= tolerance * tolerance;
  }
  else
  {
    const Point<dim> b = facet.points[2] - facet.points[0];
    const Point<dim> normal = cross(a, b);
    const double area = normal.squaredNorm();
    const double height = d.dot(normal);
    if (height * height > tolerance * tolerance * area) return false;
    const double s = cross(d, b).dot(normal) / area;
    const double t = cross(a, d).dot(normal) / area;
    return s >= -coincidence && t >= -coincidence && s + t <= 1.0 + coincidence;
  }
}

template <int dim>
[[noreturn]] void throw_hanging(const MeshData<dim>& data, Index v, const OuterFacet<dim>& facet)
{
  for (const Index w : facet.vertices)
    if ((data.vertices[w] - data.vertices[v]).norm() <= 2 * coincidence * facet.diameter)
      throw InputError(
          data.source,
          fmt::format("the mesh is not conforming: vertices {} and {} are both at {}", std::min(v, w),
                      std::max(v, w), describe(data.vertices[v])),
          "merge coincident points and meshes: \"Coherence;\" in a .geo, or \"Coherence Mesh;\"; where "
          "bodies touch without being joined, name the two sides in a [[contact]]");
  throw InputError(
      data.source,
      fmt::format("the mesh is not conforming: {} lies on the {} without being a vertex of it",
                  describe_vertex(data, v), describe_facet<dim>(data, facet.vertices)),
      "parts that touch must share their points, curves and surfaces before they are meshed: "
      "\"Coherence;\" or BooleanFragments in a .geo; where bodies touch without being joined, name "
      "the two sides in a [[contact]]");
}

/// Points of a facet that reveal an overlap with another one: its centre and, where vertices may hang, points
/// beside its corners.
template <int dim>
std::vector<Point<dim>> inner_points(const OuterFacet<dim>& facet, bool with_corners)
{
  constexpr double beside = 1e-3;
  Point<dim> centre = Point<dim>::Zero();
  for (const Point<dim>& x : facet.points) centre += x / dim;
  std::vector<Point<dim>> points = {centre};
  if (with_corners)
    for (const Point<dim>& x : facet.points) points.push_back(x + beside * (centre - x));
  return points;
}

/// Whether facets that share an inner point of one of them may do so. In planes of different directions they
/// share no more than a line; opposite sides of an interface lie on each other; and the sides of two bodies
/// that overlap may lie in one plane.
template <int dim>
bool may_overlap(const OuterFacet<dim>& a, const OuterFacet<dim>& b, const Interfaces<dim>& interfaces)
{
  constexpr double parallel = 1e-10;  // of the cosine from 1: an angle of 1e-5
  const double cosine = a.normal.dot(b.normal);
  if (1 - std::abs(cosine) > parallel || interfaces.are_opposite(a.number, b.number)) return true;
  return cosine > 0 && interfaces.may_cross(a.number, b.number);
}

template <int dim>
void check_touching(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                    const FacetSearch<dim>& search, const Interfaces<dim>& interfaces)
{
  std::vector<Index> vertices;
  for (const auto& facet : facets)
    vertices.insert(vertices.end(), facet.vertices.begin(), facet.vertices.end());
  sort_and_unite(vertices);
  std::vector<Index> touched;  // their numbers in the topology
  std::vector<const OuterFacet<dim>*> touched_facets;
  for (const Index v : vertices)
  {
    touched.clear();
    touched_facets.clear();
    search.near(data.vertices[v],
                [&](Index f)
                {
                  const auto& corners = facets[f].vertices;
                  if (std::find(corners.begin(), corners.end(), v) != corners.end()) return;
                  if (!lies_on(data.vertices[v], facets[f])) return;
                  touched.push_back(facets[f].number);
                  touched_facets.push_back(&facets[f]);
                });
    for (const OuterFacet<dim>* facet : touched_facets)
      if (!interfaces.may_touch(v, facet->number, touched)) throw_hanging(data, v, *facet);
  }
}

/// In 3D two triangulations may have the same vertices and differ in the faces only. Interfaces excuse
/// coinciding vertices, but only opposite facets.
template <int dim>
void check_overlapping(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                       const FacetSearch<dim>& search, const Interfaces<dim>& interfaces)
{
  if (dim == 2 && interfaces.empty()) return;
  for (const OuterFacet<dim>& facet : facets)
    for (const Point<dim>& x : inner_points(facet, !interfaces.empty()))
      search.near(
          x,
          [&](Index f)
          {
            const OuterFacet<dim>& other = facets[f];
            if (other.number == facet.number || !lies_on(x, other) || may_overlap(facet, other, interfaces))
              return;
            throw InputError(data.source,
                             fmt::format("the mesh is not conforming: {} and {} overlap",
                                         describe_facet<dim>(data, other.vertices),
                                         describe_facet<dim>(data, facet.vertices)),
                             "the two sides of a surface must carry the same triangles, or be the "
                             "slave and the master of one [[contact]]");
          });
}

}  // namespace

template <int dim>
void check_conformity(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                      const Interfaces<dim>& interfaces)
{
  if (facets.empty()) throw InputError(data.source, "the mesh has no boundary", "cells overlap");
  const FacetSearch<dim> search(facets);
  check_touching<dim>(data, facets, search, interfaces);
  check_overlapping<dim>(data, facets, search, interfaces);
}

template void check_conformity<2>(const MeshData<2>&, std::span<const OuterFacet<2>>, const Interfaces<2>&);
template void check_conformity<3>(const MeshData<3>&, std::span<const OuterFacet<3>>, const Interfaces<3>&);

}  // namespace tribound::mesh
