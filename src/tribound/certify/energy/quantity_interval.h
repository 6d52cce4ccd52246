#pragma once

/// @file quantity_interval.h
/// Intervals that are certain to contain a number of the exact solution.

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
  bool exact = false;    ///< but for rounding and what quadrature may miss of the loads
  std::string basis{};   ///< "equilibrium", "duality gap", "energy bound" or "second order"
  std::string note{};    ///< what else there is to know, such as a weight beside fixed displacements
  std::string reason{};  ///< why there is no interval; empty: there is one
  /// Per own cell its share in half the width, for marking; empty where it is exact.
  std::vector<double> cells{};

  /// The larger distance of the value from an end: how far it can be off.
  [[nodiscard]] double bar() const;
};

/// Makes it [lower, upper], each further out by `rounding`; where they are not finite it says so.
void set_ends(QuantityInterval& interval, double lower, double upper, double rounding);

/// What both allow, for ends that may be off by rounding: neither is empty.
void intersect(double& lower, double& upper, double other_lower, double other_upper);

/// mu N / H of numbers in [lower, upper]: N, then the components of H. Sets ends or a reason.
void set_safety_factor(QuantityInterval& interval, double coefficient, const QuantityInterval& normal,
                       const std::vector<QuantityInterval>& tangential);

}  // namespace tribound::certify
