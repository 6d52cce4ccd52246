#pragma once

/// @file formula_region.h
/// Affine functions on the convex hull of some points.

#include <array>
#include <span>

#include "tribound/problem/affine_form.h"
#include "tribound/problem/interval_series.h"

namespace tribound::problem
{

// The signs that a function takes on a region.
inline constexpr int negative = 1;
inline constexpr int zero = 2;
inline constexpr int positive = 4;
inline constexpr int any_sign = negative | zero | positive;

/// The signs of the values in `a`.
[[nodiscard]] int signs_in(const Enclosure& a);

/// The convex hull of `vertices`, dim coordinates each.
class Region
{
 public:
  Region(std::span<const double> vertices, int dim, Sides sides);

  /// f(xi + t (x - c)) for all xi and x in the region, c its centre.
  [[nodiscard]] IntervalSeries series(const AffineForm& form, int n_known) const;

  /// The signs of f.
  [[nodiscard]] int signs(const AffineForm& form) const;

 private:
  struct Range
  {
    double lower;
    double upper;
    double scale;  ///< of the terms
  };

  [[nodiscard]] Range range_of(const AffineForm& form) const;
  [[nodiscard]] std::span<const double> centre() const { return std::span(centre_).first(dim_); }

  std::span<const double> vertices_;
  int dim_;
  int n_vertices_;
  Sides sides_;
  std::array<double, 3> centre_{};
};

}  // namespace tribound::problem
