#include "tribound/certify/energy/interval_comparison.h"

namespace tribound::certify
{

namespace
{

/// Whether v and tau are admissible for the given data themselves.
bool has_all_data(const EnergyBound& bound)
{
  return bound.gap_remainder == 0 && bound.threshold_remainder == 0 && bound.direction_remainder == 0;
}

}  // namespace

IntervalComparison compare_intervals(const EnergyBound& bound, const QuantityInterval& interval,
                                     const EnergyBound& other_bound, const QuantityInterval& other)
{
  if (!interval.reason.empty()) return {.reason = interval.reason};
  if (!other.reason.empty()) return {.reason = other.reason};
  const bool meet = interval.lower <= other.upper && other.lower <= interval.upper;
  if (interval.exact && other.exact) return {.agree = meet};
  if (bound.target != EnergyTarget::solution || other_bound.target != EnergyTarget::solution)
    return {.reason = "both are of their computed friction thresholds"};
  if (!meet && !(has_all_data(bound) && has_all_data(other_bound)))
    return {.reason = "gaps, thresholds or directions are interpolated, on each mesh in another way"};
  return {.agree = meet};
}

}  // namespace tribound::certify
