#include "tribound/adapt/rate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tribound::adapt
{

namespace
{

/// The slope of log value over log N by least squares.
std::optional<double> slope(std::span<const RatePoint> points)
{
  if (!std::ranges::all_of(points, [](const RatePoint& p) { return p.dofs > 0 && p.value > 0; })) return {};
  const auto n = static_cast<double>(points.size());
  double mean_x = 0;
  double mean_y = 0;
  for (const RatePoint& p : points)
  {
    mean_x += std::log(p.dofs) / n;
    mean_y += std::log(p.value) / n;
  }
  double xx = 0;
  double xy = 0;
  for (const RatePoint& p : points)
  {
    const double x = std::log(p.dofs) - mean_x;
    xx += x * x;
    xy += x * (std::log(p.value) - mean_y);
  }
  return xx > 0 ? std::optional(xy / xx) : std::nullopt;
}

}  // namespace

std::optional<double> rate_between(const RatePoint& before, const RatePoint& now)
{
  return slope(std::array{before, now});
}

std::optional<double> fitted_rate(std::span<const RatePoint> points)
{
  constexpr std::size_t fewest = 3;  // a line fits any two points
  if (points.size() < fewest) return std::nullopt;
  return slope(points.last(std::max(fewest, (points.size() + 1) / 2)));
}

std::optional<double> value_at(std::span<const RatePoint> points, double dofs)
{
  const auto above = std::ranges::lower_bound(points, dofs, {}, &RatePoint::dofs);
  if (above == points.end()) return std::nullopt;
  if (above->dofs == dofs) return above->value;
  if (above == points.begin()) return std::nullopt;
  const RatePoint& below = *(above - 1);
  const auto rate = rate_between(below, *above);
  if (!rate) return std::nullopt;
  return below.value * std::pow(dofs / below.dofs, *rate);
}

}  // namespace tribound::adapt
