#pragma once

/// @file polygon.h
/// Convex parts of a slave facet below one master facet: intervals in 2D, polygons in 3D.

#include <cstddef>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/simplex_parts.h"

namespace tribound::contact
{

/// A point of a slave facet and its image, both in the coordinates of the reference facet.
template <int dim>
struct CornerPair
{
  Point<dim - 1> slave;
  Point<dim - 1> master;
};

/// Corners in cyclic order; in 2D the two ends. Fewer than dim corners: empty.
template <int dim>
using Polygon = std::vector<CornerPair<dim>>;

inline constexpr double snapped = 1e-12;  ///< closer to an edge than this, in barycentric coordinates: on it

/// The part of the polygon where an affine function of its corners is not negative. Values of size `snapped`
/// or less count as 0 and create no new corner.
template <int dim, class Function>
[[nodiscard]] Polygon<dim> clip(const Polygon<dim>& polygon, const Function& function)
{
  Polygon<dim> result;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    const CornerPair<dim>& a = polygon[i];
    const CornerPair<dim>& b = polygon[(i + 1) % n];
    const double at_a = function(a);
    const double at_b = function(b);
    if (at_a >= -snapped) result.push_back(a);
    const bool is_edge = dim == 3 || i == 0;  // an interval has one edge
    const bool crosses = (at_a < -snapped && at_b > snapped) || (at_a > snapped && at_b < -snapped);
    if (!is_edge || !crosses) continue;
    const double t = at_a / (at_a - at_b);
    result.push_back({a.slave + t * (b.slave - a.slave), a.master + t * (b.master - a.master)});
  }
  if (result.size() < dim) result.clear();
  return result;
}

/// Its triangulation: simplices of corner 0 and the edges that do not contain it.
template <int dim, class Visit>
void for_each_simplex(const Polygon<dim>& polygon, const Visit& visit)
{
  for (std::size_t i = 1; i + dim <= polygon.size() + 1; ++i)
  {
    fem::Part<dim - 1> on_slave;
    fem::Part<dim - 1> on_master;
    for (int k = 0; k < dim; ++k)
    {
      const CornerPair<dim>& corner = polygon[k == 0 ? 0 : i + k - 1];
      on_slave[k] = corner.slave;
      on_master[k] = corner.master;
    }
    visit(on_slave, on_master);
  }
}

/// Its measure divided by that of the slave facet.
template <int dim>
[[nodiscard]] double fraction(const Polygon<dim>& polygon)
{
  double sum = 0;
  for_each_simplex<dim>(polygon,
                        [&](const auto& slave, const auto&) { sum += fem::fraction<dim - 1>(slave); });
  return sum;
}

/// Its centroid on the slave facet; its measure must not be 0.
template <int dim>
[[nodiscard]] Point<dim - 1> centroid(const Polygon<dim>& polygon)
{
  Point<dim - 1> sum = Point<dim - 1>::Zero();
  double measure = 0;
  for_each_simplex<dim>(polygon,
                        [&](const auto& slave, const auto&)
                        {
                          const double share = fem::fraction<dim - 1>(slave);
                          measure += share;
                          for (const Point<dim - 1>& corner : slave) sum += share / dim * corner;
                        });
  return sum / measure;
}

/// Calls visit(f) for every side of the polygon, with f the distance from the side in the coordinates of the
/// slave's reference facet, f >= 0 on its inner half-plane. Skips sides of length 0.
template <int dim, class Visit>
void for_each_side(const Polygon<dim>& polygon, const Visit& visit)
{
  if constexpr (dim == 2)
  {
    const double sign = polygon[0].slave[0] < polygon[1].slave[0] ? 1 : -1;
    visit([&](const CornerPair<2>& x) { return sign * (x.slave[0] - polygon[0].slave[0]); });
    visit([&](const CornerPair<2>& x) { return sign * (polygon[1].slave[0] - x.slave[0]); });
  }
  else
  {
    const Point<2> inside = centroid<3>(polygon);
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const Point<2> from = polygon[i].slave;
      const Point<2> edge = polygon[(i + 1) % polygon.size()].slave - from;
      if (edge.norm() == 0) continue;
      Point<2> normal = Point<2>(-edge[1], edge[0]).normalized();
      if (normal.dot(inside - from) < 0) normal = -normal;
      visit([&](const CornerPair<3>& x) { return normal.dot(x.slave - from); });
    }
  }
}

/// Whether two parts of one facet overlap by more than rounding.
template <int dim>
[[nodiscard]] bool overlap(const fem::Part<dim - 1>& a, const fem::Part<dim - 1>& b)
{
  constexpr double rounding = 1e-11;
  Polygon<dim> common;
  Polygon<dim> sides;
  for (const Point<dim - 1>& x : a) common.push_back({x, x});
  for (const Point<dim - 1>& x : b) sides.push_back({x, x});
  for_each_side<dim>(sides, [&](const auto& distance) { common = clip<dim>(common, distance); });
  return !common.empty() && fraction<dim>(common) > rounding;
}

}  // namespace tribound::contact
