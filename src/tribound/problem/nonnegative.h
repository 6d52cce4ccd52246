#pragma once

/// @file nonnegative.h
/// Data that must not be negative.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/problem/field.h"
#include "tribound/problem/formula.h"

namespace tribound::problem
{

/// The value at x, >= 0. A negative value counts as 0 if it may be 0 within the rounding of x: "y" on a floor
/// y = 0 whose points have rounded coordinates. Otherwise throws InputError naming the point.
template <int dim>
[[nodiscard]] double nonnegative_at(const Field& field, const Point<dim>& x)
{
  constexpr double rounding = 1e-12;  // of a point on a facet, relative to its coordinates
  const double value = field(x);
  if (value >= 0) return value;
  const double radius = rounding * x.template lpNorm<Eigen::Infinity>();
  const double upper = field.is_enclosed() ? field.around({x.data(), dim}, radius).upper : value + radius;
  if (upper < 0)
    throw InputError(field.where(),
                     fmt::format("is negative, {:.9g}, at the point ({:.9g})", value,
                                 fmt::join(x.data(), x.data() + dim, ", ")),
                     nonnegative_hint);
  return 0;
}

}  // namespace tribound::problem
