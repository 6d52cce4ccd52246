#pragma once

/// @file quantity_interval.h
/// Intervals that are guaranteed to contain a number of the exact solution.

#include <string>
#include <vector>

namespace tribound::certify
{

/// lower <= the number of the exact solution <= upper.
struct QuantityInterval
{
  std::string name{};
  double value = 0;  ///< of u_h; it may lie outside
  double lower = 0;
  double upper = 0;
  bool exact = false;    ///< except for rounding and what quadrature may miss of the loads
  std::string basis{};   ///< "equilibrium", "duality gap", "energy bound" or "second order"
  std::string note{};    ///< further remarks, such as a weight beside fixed displacements
  std::string reason{};  ///< why there is no interval; empty: there is one
  /// The share of each own cell in half the width, for marking; empty if exact.
  std::vector<double> cells{};

  /// The larger distance of the value from an end: the largest possible error.
  [[nodiscard]] double bar() const;
};

/// Sets [lower, upper], widened by `rounding` at both ends; if the ends are not finite, sets a reason.
void set_ends(QuantityInterval& interval, double lower, double upper, double rounding);

/// The intersection, for ends that may be off by rounding: it is never empty.
void intersect(double& lower, double& upper, double other_lower, double other_upper);

/// mu N / H for numbers in intervals: N, then the components of H. Sets ends or a reason.
void set_safety_factor(QuantityInterval& interval, double coefficient, const QuantityInterval& normal,
                       const std::vector<QuantityInterval>& tangential);

}  // namespace tribound::certify
