#pragma once

/// @file contact_pieces.h
/// Pieces of contact segments, into which ContactTerms divides them. Internal to it.

#include <array>
#include <cstddef>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/problem/normal_field.h"

namespace tribound::certify
{

/// More pieces than the data require: so many are left only if rounding makes the kinks.
inline constexpr std::size_t max_pieces = 4096;
/// What a rule on a piece may miss of a norm, divided by the largest distance from the polynomials for which
/// it is exact, if the projection of the values decides about kinks.
inline constexpr double misses = 3;

/// The parts of a segment or triangle whose edges are halved.
[[nodiscard]] inline std::array<std::array<Point<1>, 2>, 2> halves(const std::array<Point<1>, 2>& s)
{
  const Point<1> middle = (s[0] + s[1]) / 2;
  return {{{s[0], middle}, {middle, s[1]}}};
}
[[nodiscard]] inline std::array<std::array<Point<2>, 3>, 4> halves(const std::array<Point<2>, 3>& s)
{
  const Point<2> a = (s[1] + s[2]) / 2;
  const Point<2> b = (s[0] + s[2]) / 2;
  const Point<2> c = (s[0] + s[1]) / 2;
  return {{{s[0], c, b}, {c, s[1], a}, {b, a, s[2]}, {a, b, c}}};
}

/// h_k |k| / |reference simplex|.
template <int dim>
[[nodiscard]] double norm_scale(const contact::ContactSegment<dim>& segment)
{
  return segment.h * segment.det();
}

/// How far N may be from polynomials on a part of a segment.
template <int dim>
[[nodiscard]] problem::NormalDeviation deviation_on(const contact::SimplexMap<dim - 1, dim>& map,
                                                    const problem::NormalField& normal,
                                                    const fem::Part<dim - 1>& part)
{
  return problem::deviation(normal, contact::corner_coordinates(map, part), dim);
}

/// The distance of v - v.N N from P^{p+2}, relative to |v|, for v in P^p; in 2D along the tangent.
template <int dim>
[[nodiscard]] double tangential_deviation(const problem::NormalDeviation& deviation)
{
  return dim == 2 ? deviation.quadratic : deviation.linear * (2 + deviation.linear);
}

}  // namespace tribound::certify
