#pragma once

/// @file polynomials.h
/// Orthonormal polynomials on the reference simplex (Dubiner/Koornwinder), ordered by degree.

#include <array>
#include <span>

#include "tribound/base/types.h"

namespace tribound::fem
{

/// dim P^degree(R^k) = binomial(degree + k, k).
[[nodiscard]] constexpr int polynomial_dimension(int k, int degree)
{
  int n = 1;
  for (int i = 1; i <= k; ++i) n = n * (degree + i) / i;
  return degree < 0 ? 0 : n;
}

/// The barycentric coordinates of a reference point, the origin's first.
template <int k>
[[nodiscard]] std::array<double, k + 1> barycentric(const Point<k>& x)
{
  std::array<double, k + 1> lambda;
  lambda[0] = 1 - x.sum();
  for (int i = 0; i < k; ++i) lambda[i + 1] = x[i];
  return lambda;
}

/// Values at x of an orthonormal basis of P^degree on the reference k-simplex; the first
/// polynomial_dimension(k, m) of them span P^m, so that truncation is the L2 projection.
template <int k>
void orthonormal_values(int degree, const Point<k>& x, std::span<double> values);

/// Values and gradients.
template <int k>
void orthonormal_gradients(int degree, const Point<k>& x, std::span<double> values,
                           std::span<Point<k>> gradients);

}  // namespace tribound::fem
