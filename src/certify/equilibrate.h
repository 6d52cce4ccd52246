#pragma once

/// @file equilibrate.h
/// The equilibrated stress of a Newton iterate, method section 4.

#include <span>

#include "certify/stress.h"
#include "contact/nitsche.h"

namespace tribound
{

/// sigma_dis and sigma_lin of the iterate u^k with running traction t^k (at the contact points of the form),
/// rebuilt on vertex patches in the Arnold-Falk-Winther spaces of the degree of the space [FD24, section 4].
/// Runs on `n_threads` threads (0: as many as OpenMP offers); the result does not depend on their number.
/// Throws SolveError where a patch has no equilibrated stress.
template <int dim>
[[nodiscard]] Stress<dim> equilibrate(const NitscheForm<dim>& form, std::span<const double> u,
                                      std::span<const Point<dim>> t, int n_threads = 0);

}  // namespace tribound
