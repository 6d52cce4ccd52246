#include "tribound/certify/energy/interval_comparison.h"

#include <gtest/gtest.h>

namespace tribound::interval_comparison_cases
{
namespace
{

using certify::compare_intervals;
using certify::EnergyBound;
using certify::EnergyTarget;
using certify::QuantityInterval;

const QuantityInterval low{.name = "force", .lower = 1, .upper = 2};
const QuantityInterval middle{.name = "force", .lower = 2, .upper = 3};
const QuantityInterval high{.name = "force", .lower = 2.5, .upper = 4};
const EnergyBound plain{};

TEST(IntervalComparison, IntervalsOfOneNumberHaveAPointInCommon)
{
  EXPECT_EQ(compare_intervals(plain, low, plain, middle).agree, true);
  EXPECT_EQ(compare_intervals(plain, middle, plain, high).agree, true);
  EXPECT_EQ(compare_intervals(plain, low, plain, high).agree, false);
  EXPECT_EQ(compare_intervals(plain, high, plain, low).agree, false);
}

TEST(IntervalComparison, NothingIsSaidOfOneThatIsMissing)
{
  const QuantityInterval none{.name = "force", .reason = "contact alone holds a body"};
  for (const auto& found :
       {compare_intervals(plain, none, plain, low), compare_intervals(plain, low, plain, none)})
  {
    EXPECT_EQ(found.agree, std::nullopt);
    EXPECT_EQ(found.reason, none.reason);
  }
}

/// Whether intervals with and without a common point are compared, if these are the bounds of one or both.
void expect_compared(const EnergyBound& bound, const EnergyBound& other, bool with, bool without)
{
  EXPECT_EQ(compare_intervals(bound, low, other, middle).agree.has_value(), with);
  const auto apart = compare_intervals(bound, low, other, high);
  EXPECT_EQ(apart.agree.has_value(), without);
  EXPECT_EQ(apart.reason.empty(), without);
}

TEST(IntervalComparison, WhatMayDifferIsNoContradiction)
{
  const EnergyBound coulomb{.target = EnergyTarget::computed_friction};
  const EnergyBound with_gap{.gap_remainder = 1e-9};
  const EnergyBound with_threshold{.threshold_remainder = 1e-9};
  expect_compared(plain, plain, true, true);
  expect_compared(coulomb, plain, false, false);
  expect_compared(plain, coulomb, false, false);
  for (const EnergyBound& bound : {with_gap, with_threshold})
  {
    expect_compared(bound, plain, true, false);
    expect_compared(plain, bound, true, false);
  }
}

TEST(IntervalComparison, WhatIsExactIsComparedAlways)
{
  const EnergyBound other{.target = EnergyTarget::computed_friction, .gap_remainder = 1};
  QuantityInterval one = low;
  QuantityInterval another = high;
  one.exact = another.exact = true;
  EXPECT_EQ(compare_intervals(other, one, other, another).agree, false);
  EXPECT_EQ(compare_intervals(other, one, other, one).agree, true);
}

}  // namespace
}  // namespace tribound::interval_comparison_cases
