#pragma once

/// @file heated_cylinder.h
/// A long cylinder that is hotter inside.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/problem_data.h"

namespace tribound::test
{

/// A cylinder with radii 1 and 2 in plane strain, whose temperature falls like the logarithm of r from
/// `inside` to 0 [Timoshenko and Goodier, Theory of Elasticity, section 151].
struct HeatedCylinder
{
  double alpha = 1e-3;
  double nu = 0.3;
  double inside = 5;

  [[nodiscard]] problem::Field temperature() const
  {
    return formula(fmt::format("{:.17g}*log(2/x)", inside / std::numbers::ln2));
  }

  [[nodiscard]] double u_r(double r) const
  {
    const double factor = alpha * (1 + nu) / (1 - nu);
    const double c2 = factor * moment(2) / 3;
    return factor * moment(r) / r + (1 - 2 * nu) * c2 * r + c2 / r;
  }

 private:
  /// The integral of the temperature times r from 1 to r.
  [[nodiscard]] double moment(double r) const
  {
    const auto at = [](double x) { return x * x / 2 * std::log(x / 2) - x * x / 4; };
    return -inside / std::numbers::ln2 * (at(r) - at(1));
  }
};

}  // namespace tribound::test
