#pragma once

/// @file rate.h
/// Rates of convergence: the exponent r of a quantity that behaves like c N^r, N being the degrees of
/// freedom.

#include <optional>
#include <span>

namespace tribound::adapt
{

/// A quantity that is known at so many degrees of freedom.
struct RatePoint
{
  double dofs;   ///< > 0
  double value;  ///< >= 0
};

/// log(value / value before) / log(N / N before); nothing where a value is 0 or N does not change.
[[nodiscard]] std::optional<double> rate_between(const RatePoint& before, const RatePoint& now);

/// The slope of log value over log N by least squares over the last half of the points, at least three of
/// them; the middle one of an odd number counts. Nothing where there are fewer than three, where a value is 0
/// or N does not change.
[[nodiscard]] std::optional<double> fitted_rate(std::span<const RatePoint> points);

/// The value at `dofs` degrees of freedom: c N^r between the two neighbouring points. `points` ascend in N.
/// Nothing outside their range and where a value is 0.
[[nodiscard]] std::optional<double> value_at(std::span<const RatePoint> points, double dofs);

}  // namespace tribound::adapt
