#include "tribound/problem/interval.h"

#include <numbers>

namespace tribound::problem
{
namespace
{

/// Whether some offset + k period, k integer, lies in `a`, or so near that rounding does not rule it out.
bool contains_multiple(const Enclosure& a, double offset, double period)
{
  const double slack = 16 * std::numeric_limits<double>::epsilon() * (a.magnitude() + period);
  const double k = std::ceil((a.lower - slack - offset) / period);
  return offset + k * period <= a.upper + slack;
}

/// The image under a function that is 1 at maximum + 2 pi k, -1 half a period from there, and monotone in
/// between.
template <class Function>
Enclosure wave(const Enclosure& a, double maximum, Function function)
{
  constexpr double pi = std::numbers::pi;
  const double u = function(a.lower);
  const double v = function(a.upper);
  Enclosure image = outward(std::min(u, v), std::max(u, v), library_error);
  if (contains_multiple(a, maximum, 2 * pi)) image.upper = 1.0;
  if (contains_multiple(a, maximum - pi, 2 * pi)) image.lower = -1.0;
  return {std::max(image.lower, -1.0), std::min(image.upper, 1.0)};
}

}  // namespace

Enclosure cosine(const Enclosure& a)
{
  return wave(a, 0.0, [](double x) { return std::cos(x); });
}

Enclosure sine(const Enclosure& a)
{
  return wave(a, std::numbers::pi / 2, [](double x) { return std::sin(x); });
}

bool has_pole_of_tangent(const Enclosure& a)
{
  return contains_multiple(a, std::numbers::pi / 2, std::numbers::pi);
}

Enclosure integer_power(const Enclosure& a, int n)
{
  if (n == 0) return exactly(1.0);
  const double u = std::pow(a.lower, n);
  const double v = std::pow(a.upper, n);
  if (n % 2 == 0 && a.contains(0.0)) return outward(0.0, std::max(u, v), library_error);
  return outward(std::min(u, v), std::max(u, v), library_error);
}

Enclosure real_power(const Enclosure& a, const Enclosure& b)
{
  // Monotone in each argument: the extreme values are at the corners.
  const double p = std::pow(a.lower, b.lower);
  const double q = std::pow(a.lower, b.upper);
  const double r = std::pow(a.upper, b.lower);
  const double s = std::pow(a.upper, b.upper);
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)),
                 library_error);
}

}  // namespace tribound::problem
