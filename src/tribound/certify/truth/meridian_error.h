#pragma once

/// @file meridian_error.h
/// The integrals of solution_error.h for axisymmetric problems: with the weight r and the hoop strain, by
/// rules for polynomials over r. They are those of one radian.

#include <span>

#include "tribound/certify/truth/solution_error.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// solution_error() with squares in place of their roots, over the own cells of the reference.
[[nodiscard]] LocalError meridian_squares(const problem::Problem<2>& problem,
                                          const fem::LagrangeSpace<2>& space, std::span<const double> u,
                                          const fem::LagrangeSpace<2>& reference_space,
                                          std::span<const double> u_ref);

/// stress_error() with squares in place of their roots, over the own cells of the reference.
[[nodiscard]] StressError meridian_stress_squares(const problem::Problem<2>& problem,
                                                  const fem::LagrangeSpace<2>& space,
                                                  std::span<const Tensor<2>> s, std::span<const double> hoop,
                                                  const fem::LagrangeSpace<2>& reference_space,
                                                  std::span<const double> u_ref);

}  // namespace tribound::certify
