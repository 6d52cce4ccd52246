#pragma once

/// @file interval_comparison.h
/// Intervals of one number from two solutions of one problem, on meshes that come from one first mesh.

#include <optional>
#include <string>

#include "tribound/certify/energy/energy_bound.h"

namespace tribound::certify
{

/// What two intervals of a number say of each other.
struct IntervalComparison
{
  std::optional<bool> agree{};  ///< whether they have a point in common; absent: that is not for certain
  std::string reason{};         ///< why it is not
};

/// Both hold the number of the exact solution, and so have a point in common. Nothing is said where there are
/// no two intervals and of the computed friction threshold, which differs; nor, if they have no common point,
/// where data were interpolated, and so were not the same. What is exact is compared always. `bound` is the
/// one that `interval` is of.
[[nodiscard]] IntervalComparison compare_intervals(const EnergyBound& bound, const QuantityInterval& interval,
                                                   const EnergyBound& other_bound,
                                                   const QuantityInterval& other);

}  // namespace tribound::certify
