#pragma once

/// @file interval_comparison.h
/// Intervals of one number from two solutions of one problem, on meshes made from one first mesh.

#include <optional>
#include <string>

#include "tribound/certify/energy/energy_bound.h"

namespace tribound::certify
{

/// The result of comparing two intervals of a number.
struct IntervalComparison
{
  std::optional<bool> agree{};  ///< whether they have a point in common; absent: that is uncertain
  std::string reason{};         ///< why it is uncertain
};

/// Both intervals contain the number of the exact solution, so they have a point in common. Nothing is said
/// without two intervals, nor for the computed friction threshold, which differs. If they are disjoint,
/// nothing is said if data were interpolated and so were not the same. Exact intervals are always compared.
/// `bound` is the one to which `interval` belongs.
[[nodiscard]] IntervalComparison compare_intervals(const EnergyBound& bound, const QuantityInterval& interval,
                                                   const EnergyBound& other_bound,
                                                   const QuantityInterval& other);

}  // namespace tribound::certify
