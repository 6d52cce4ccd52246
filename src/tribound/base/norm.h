#pragma once

/// @file norm.h
/// Euclidean norm and inner product of vectors.

#include <cmath>
#include <cstddef>
#include <span>

namespace tribound
{

[[nodiscard]] inline double inner_product(std::span<const double> x, std::span<const double> y)
{
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

[[nodiscard]] inline double norm(std::span<const double> v)
{
  return std::sqrt(inner_product(v, v));
}

}  // namespace tribound
