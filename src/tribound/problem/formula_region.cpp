#include "tribound/problem/formula_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tribound::problem
{
namespace
{

int sign_of(double value)
{
  return value < 0.0 ? negative : value > 0.0 ? positive : zero;
}

}  // namespace

int signs_in(const Enclosure& a)
{
  return (a.lower < 0.0 ? negative : 0) | (a.contains(0.0) ? zero : 0) | (a.upper > 0.0 ? positive : 0);
}

Region::Region(std::span<const double> vertices, int dim, Sides sides)
    : vertices_(vertices), dim_(dim), n_vertices_(static_cast<int>(vertices.size()) / dim), sides_(sides)
{
  for (int i = 0; i < n_vertices_; ++i)
    for (int k = 0; k < dim_; ++k) centre_[k] += vertices_[i * dim_ + k] / n_vertices_;
}

Region::Range Region::range_of(const AffineForm& form) const
{
  Range range = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0.0};
  for (int i = 0; i < n_vertices_; ++i)
  {
    const auto x = vertices_.subspan(i * dim_, dim_);
    const double value = form.value(x);
    range.lower = std::min(range.lower, value);
    range.upper = std::max(range.upper, value);
    range.scale = std::max(range.scale, form.scale(x));
  }
  return range;
}

IntervalSeries Region::series(const AffineForm& form, int n_known) const
{
  const bool is_literal = form.is_number() && form.n_operations == 1;
  if (is_literal) return constant_series(exactly(form.c[3]), n_known);
  const Range range = range_of(form);
  const double e = form.rounding(range.scale);
  const double at_centre = form.value(centre());
  IntervalSeries result = constant_series({range.lower - e, range.upper + e}, n_known);
  if (result.n_known < 2 || form.is_number()) return result;
  result.c[1] = {range.lower - at_centre - 2 * e, range.upper - at_centre + 2 * e};
  result.length = 2;
  return result;
}

int Region::signs(const AffineForm& form) const
{
  constexpr double relative_rounding = 1e-12;
  if (form.is_constant()) return sign_of(form.c[3]);
  const Range range = range_of(form);
  if (!std::isfinite(range.scale)) return any_sign;
  // A facet in the plane x = a: x > b is decided in the same way at all of its points, too.
  const bool is_exact = range.lower == range.upper && form.is_shifted_variable();
  const double e = is_exact ? 0.0 : form.rounding(range.scale);
  const int closed_signs = signs_in({range.lower - e, range.upper + e});
  if (sides_ == Sides::closed) return closed_signs;
  const double tolerance = relative_rounding * range.scale;
  if (sides_ == Sides::around) return signs_in({range.lower - tolerance, range.upper + tolerance});
  const bool never_below = range.lower >= -tolerance;
  const bool never_above = range.upper <= tolerance;
  if (never_below && never_above) return closed_signs;  // no inside to decide
  return never_below ? positive : never_above ? negative : any_sign;
}

}  // namespace tribound::problem
