#pragma once

/// @file norm.h

#include <cmath>
#include <span>

namespace tribound
{

/// Euclidean length.
[[nodiscard]] inline double norm(std::span<const double> v)
{
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

}  // namespace tribound
