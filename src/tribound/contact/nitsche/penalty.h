#pragma once

/// @file penalty.h
/// Nitsche's parameter gamma = gamma_0 min(lambda + 2 mu, 34 mu) / h_F.

#include <algorithm>

#include "tribound/problem/material.h"

namespace tribound::contact
{

/// The default gamma_0, method section 2: 10 up to degree 3, above max(10, 3 p^2).
[[nodiscard]] inline double default_gamma0(int degree)
{
  return degree <= 3 ? 10.0 : std::max(10.0, 3.0 * degree * degree);
}

/// The modulus in gamma: lambda + 2 mu, but at most its value at nu = 16/33 = 0.485. Otherwise nearly
/// incompressible materials would have a penalty of the size of lambda against all deformation, and Newton's
/// method fails (docs/choosing.md).
[[nodiscard]] inline double penalty_modulus(const problem::Material& material)
{
  constexpr double largest = 34;  // of (lambda + 2 mu) / mu = (2 - 2 nu) / (1 - 2 nu)
  return std::min(material.lambda + 2 * material.mu, largest * material.mu);
}

}  // namespace tribound::contact
