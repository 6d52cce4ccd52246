#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/outer_facets.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

template <int dim>
BoxTree<dim> tree_of(std::span<const OuterFacet<dim>> facets)
{
  std::vector<BoundingBox<dim>> boxes;
  for (const OuterFacet<dim>& facet : facets) boxes.push_back(bounding_box<dim>(facet.points));
  return BoxTree<dim>(boxes);
}

/// Barycentric coordinates in the facet of a point of its plane.
template <int dim>
std::array<double, dim> barycentric(const OuterFacet<dim>& facet, const Point<dim>& x)
{
  const Point<dim> d = x - facet.points[0];
  const Point<dim> a = facet.points[1] - facet.points[0];
  if constexpr (dim == 2)
  {
    const double t = d.dot(a) / a.squaredNorm();
    return {1 - t, t};
  }
  else
  {
    const Point<dim> b = facet.points[2] - facet.points[0];
    const Point<dim> normal = cross(a, b);
    const double s = cross(d, b).dot(normal) / normal.squaredNorm();
    const double t = cross(a, d).dot(normal) / normal.squaredNorm();
    return {1 - s - t, s, t};
  }
}

/// Where the segment from a to b, its ends clear of the facet's plane, crosses the facet; nothing if it does
/// not. A crossing on the rim of the facet counts.
template <int dim>
std::optional<Point<dim>> crossing(const Point<dim>& a, const Point<dim>& b, const OuterFacet<dim>& facet)
{
  const double height_a = facet.normal.dot(a - facet.points[0]);
  const double height_b = facet.normal.dot(b - facet.points[0]);
  const double clear = coincidence * std::max((b - a).norm(), facet.diameter);
  if (height_a * height_b >= 0 || std::min(std::abs(height_a), std::abs(height_b)) <= clear)
    return std::nullopt;
  const Point<dim> x = a + height_a / (height_a - height_b) * (b - a);
  const auto coordinates = barycentric(facet, x);
  if (*std::ranges::min_element(coordinates) < -coincidence) return std::nullopt;
  return x;
}

/// Where an edge of `first` crosses `second`, except edges that share a vertex with it.
template <int dim>
std::optional<Point<dim>> crossing(const OuterFacet<dim>& first, const OuterFacet<dim>& second)
{
  const auto shared = [&](int i)
  { return std::ranges::find(second.vertices, first.vertices[i]) != second.vertices.end(); };
  for (int i = 0; i < dim; ++i)
    for (int j = i + 1; j < dim; ++j)
      if (!shared(i) && !shared(j))
        if (auto x = crossing(first.points[i], first.points[j], second)) return x;
  return std::nullopt;
}

constexpr auto hint =
    "bodies must not intersect: move one of them, or make one of them (BooleanFragments, \"Coherence;\" in a "
    ".geo)";

template <int dim>
void check_crossings(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                     const BoxTree<dim>& tree, const Interfaces<dim>& interfaces)
{
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    const BoundingBox<dim> own = bounding_box<dim>(facets[f].points);
    tree.traverse([&](const BoundingBox<dim>& box) { return meet(box, own); },
                  [&](std::size_t g)
                  {
                    if (f == g || interfaces.may_cross(facets[f].number, facets[g].number)) return;
                    if (const auto x = crossing(facets[f], facets[g]))
                      throw InputError(
                          data.source,
                          fmt::format("the mesh overlaps itself: {} and {} of its boundary cross at {}",
                                      describe_facet<dim>(data, facets[f].vertices),
                                      describe_facet<dim>(data, facets[g].vertices), describe(*x)),
                          hint);
                  });
  }
}

/// How many cells cover the points just outside the facet: as many as a ray from there leaves more than it
/// enters. Nothing if it meets the rim of a facet. Bodies that an interface joins with that of the facet do
/// not count.
template <int dim>
std::optional<int> cover(std::span<const OuterFacet<dim>> facets, const BoxTree<dim>& tree,
                         const Interfaces<dim>& interfaces, std::size_t start, const Point<dim>& direction)
{
  Point<dim> from = Point<dim>::Zero();
  for (const Point<dim>& x : facets[start].points) from += x / dim;
  const auto meets = [&](const BoundingBox<dim>& box)
  {
    const auto [first, last] = part_in_box(box, from, direction, {0, HUGE_VAL});
    return first <= last * (1 + coincidence);
  };
  int sum = 0;
  bool is_clear = true;
  tree.traverse(meets,
                [&](std::size_t f)
                {
                  const OuterFacet<dim>& facet = facets[f];
                  const double slope = facet.normal.dot(direction);
                  if (f == start || interfaces.may_cross(facets[start].number, facet.number)) return;
                  const double distance = facet.normal.dot(facet.points[0] - from);
                  if (slope == 0 || distance / slope <= 0) return;
                  const auto coordinates = barycentric<dim>(facet, from + distance / slope * direction);
                  const double inside = *std::ranges::min_element(coordinates);
                  if (std::abs(inside) < coincidence) is_clear = false;
                  if (inside > 0) sum += slope > 0 ? 1 : -1;
                });
  return is_clear ? std::optional(sum) : std::nullopt;
}

/// A facet of every connected part of the boundary, from which the outside is examined. No facet of a slit:
/// outside of it its own body continues.
template <int dim>
std::vector<std::size_t> parts(std::span<const OuterFacet<dim>> facets, std::size_t n_vertices,
                               const Interfaces<dim>& interfaces)
{
  std::vector<Index> parent(n_vertices);
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index v)
  {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& facet : facets)
    for (int i = 1; i < dim; ++i) parent[root(facet.vertices[i])] = root(facet.vertices[0]);
  std::vector<std::size_t> first;
  std::vector<bool> seen(n_vertices, false);
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    if (interfaces.is_of_slit(facets[f].number)) continue;
    const Index r = root(facets[f].vertices[0]);
    if (!seen[r]) first.push_back(f);
    seen[r] = true;
  }
  return first;
}

/// Boundaries that do not cross are inside other cells as a whole, or not at all.
template <int dim>
void check_covers(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                  const BoxTree<dim>& tree, const Interfaces<dim>& interfaces)
{
  for (const std::size_t f : parts(facets, data.vertices.size(), interfaces))
    for (int attempt = 1; attempt <= 8; ++attempt)
    {
      // Outwards, and in no direction that a mesh has.
      Point<dim> direction = facets[f].normal;
      for (int i = 0; i < dim; ++i) direction[i] += 0.2 * std::sin(attempt + 0.7 * i);
      const std::optional<int> n = cover(facets, tree, interfaces, f, direction);
      if (!n) continue;
      if (*n == 0) break;
      throw InputError(data.source,
                       fmt::format("the mesh overlaps itself: {} of its boundary lies inside other cells",
                                   describe_facet<dim>(data, facets[f].vertices)),
                       hint);
    }
}

}  // namespace

template <int dim>
void check_overlap(const MeshData<dim>& data, std::span<const OuterFacet<dim>> facets,
                   const Interfaces<dim>& interfaces)
{
  const BoxTree<dim> tree = tree_of<dim>(facets);
  check_crossings<dim>(data, facets, tree, interfaces);
  check_covers<dim>(data, facets, tree, interfaces);
}

template void check_overlap<2>(const MeshData<2>&, std::span<const OuterFacet<2>>, const Interfaces<2>&);
template void check_overlap<3>(const MeshData<3>&, std::span<const OuterFacet<3>>, const Interfaces<3>&);

}  // namespace tribound::mesh
