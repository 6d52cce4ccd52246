#pragma once

/// @file interval.h
/// Interval arithmetic. The ends of a result are moved outward by more than their rounding error (for a
/// function of the C library, by more than its error), so that the rounding mode need not be switched. Only
/// underflow is not enclosed.

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/problem/formula.h"

namespace tribound::problem
{

/// Units in the last place by which a function of the C library may be off, with a margin.
inline constexpr int library_error = 4;

[[nodiscard]] inline Enclosure outward(double lower, double upper, int n_ulp = 1)
{
  const double e = n_ulp * std::numeric_limits<double>::epsilon();
  return {lower - e * std::abs(lower), upper + e * std::abs(upper)};
}

[[nodiscard]] inline Enclosure exactly(double value)
{
  return {value, value};
}

/// Whether nothing has overflowed.
[[nodiscard]] inline bool is_finite(const Enclosure& a)
{
  return std::isfinite(a.lower) && std::isfinite(a.upper);
}

[[nodiscard]] inline Enclosure operator-(const Enclosure& a)
{
  return {-a.upper, -a.lower};
}

[[nodiscard]] inline Enclosure operator+(const Enclosure& a, const Enclosure& b)
{
  return outward(a.lower + b.lower, a.upper + b.upper);
}

[[nodiscard]] inline Enclosure operator-(const Enclosure& a, const Enclosure& b)
{
  return outward(a.lower - b.upper, a.upper - b.lower);
}

[[nodiscard]] inline Enclosure operator*(const Enclosure& a, const Enclosure& b)
{
  if (!is_finite(a) || !is_finite(b)) return {};  // inf * 0 would be lost in min and max
  const double p = a.lower * b.lower;
  const double q = a.lower * b.upper;
  const double r = a.upper * b.lower;
  const double s = a.upper * b.upper;
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

/// Expects that `b` does not contain 0.
[[nodiscard]] inline Enclosure operator/(const Enclosure& a, const Enclosure& b)
{
  if (!is_finite(a) || !is_finite(b)) return {};
  const double p = a.lower / b.lower;
  const double q = a.lower / b.upper;
  const double r = a.upper / b.lower;
  const double s = a.upper / b.upper;
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

/// The smallest interval that contains both.
[[nodiscard]] inline Enclosure hull(const Enclosure& a, const Enclosure& b)
{
  return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
}

/// The smallest |value|.
[[nodiscard]] inline double mignitude(const Enclosure& a)
{
  return std::max({a.lower, -a.upper, 0.0});
}

/// The image under an increasing function of the C library.
template <class Function>
[[nodiscard]] Enclosure increasing(const Enclosure& a, Function function)
{
  return outward(function(a.lower), function(a.upper), library_error);
}

[[nodiscard]] Enclosure cosine(const Enclosure& a);
[[nodiscard]] Enclosure sine(const Enclosure& a);
/// Whether the tangent has a pole in `a` (or so near that it cannot be told).
[[nodiscard]] bool has_pole_of_tangent(const Enclosure& a);

/// a^n for n >= 0.
[[nodiscard]] Enclosure integer_power(const Enclosure& a, int n);
/// a^b for a >= 0; b > 0 if a contains 0.
[[nodiscard]] Enclosure real_power(const Enclosure& a, const Enclosure& b);

}  // namespace tribound::problem
