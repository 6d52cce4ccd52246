#pragma once

/// @file rate.h
/// Rates of convergence: the exponent r of a quantity that behaves like c N^r, where N is the number of
/// degrees of freedom.

#include <optional>
#include <span>

namespace tribound::adapt
{

/// A quantity at a number of degrees of freedom.
struct RatePoint
{
  double dofs;   ///< > 0
  double value;  ///< >= 0
};

/// log(value / previous value) / log(N / previous N); nothing where a value is 0 or N does not change.
[[nodiscard]] std::optional<double> rate_between(const RatePoint& before, const RatePoint& now);

/// The slope of log value over log N by least squares over the last half of the points, including the middle
/// one of an odd number, but at least three. Nothing where there are fewer than three, where a value is 0 or
/// N does not change.
[[nodiscard]] std::optional<double> fitted_rate(std::span<const RatePoint> points);

/// The value at `dofs` degrees of freedom: c N^r between the two neighbouring points. `points` are in
/// ascending order of N. Nothing outside their range and where a value is 0.
[[nodiscard]] std::optional<double> value_at(std::span<const RatePoint> points, double dofs);

}  // namespace tribound::adapt
