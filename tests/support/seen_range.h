#pragma once

/// @file seen_range.h
/// The range of what a test has observed.

#include <algorithm>
#include <cmath>

namespace tribound::test
{

/// The smallest and the largest of the numbers seen.
struct SeenRange
{
  double least = HUGE_VAL;
  double most = 0;
  int count = 0;

  void add(double number)
  {
    least = std::min(least, number);
    most = std::max(most, number);
    ++count;
  }
};

}  // namespace tribound::test
