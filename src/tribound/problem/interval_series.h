#pragma once

/// @file interval_series.h
/// Truncated Taylor series with interval coefficients, f(X(t)) = c_0 + c_1 t + ... (A. Griewank, A. Walther,
/// "Evaluating Derivatives", chapter 13; W. Tucker, "Validated Numerics", chapter 5).

#include <array>

#include "tribound/problem/formula_program.h"
#include "tribound/problem/interval.h"

namespace tribound::problem
{

/// The first `n_known` coefficients are finite intervals, zero from `length` on. The others are unknown: all
/// of them where the function may be undefined, all but the first where it may jump or kink.
struct IntervalSeries
{
  int n_known = 0;
  int length = 0;
  std::array<Enclosure, Formula::max_order + 1> c;
};

/// The constant series of `value`.
[[nodiscard]] IntervalSeries constant_series(const Enclosure& value, int n_known);
/// Values in `value`, unknown derivatives.
[[nodiscard]] IntervalSeries values_only(const Enclosure& value);
/// Nothing known.
[[nodiscard]] IntervalSeries unknown_series();

// For series with at least one known coefficient.
[[nodiscard]] IntervalSeries negate(const IntervalSeries& a);
[[nodiscard]] IntervalSeries add(const IntervalSeries& a, const IntervalSeries& b);
[[nodiscard]] IntervalSeries subtract(const IntervalSeries& a, const IntervalSeries& b);
[[nodiscard]] IntervalSeries multiply(const IntervalSeries& a, const IntervalSeries& b);
[[nodiscard]] IntervalSeries divide(const IntervalSeries& a, const IntervalSeries& b);
[[nodiscard]] IntervalSeries integer_power(const IntervalSeries& a, int n);
[[nodiscard]] IntervalSeries power(const IntervalSeries& a, const IntervalSeries& b);
[[nodiscard]] IntervalSeries arc_tangent(const IntervalSeries& y, const IntervalSeries& x);
/// One of the smooth functions of one argument.
[[nodiscard]] IntervalSeries smooth_function(Op op, const IntervalSeries& a);

}  // namespace tribound::problem
