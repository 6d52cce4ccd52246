#pragma once

/// @file residual.h
/// The residual of the discrete problem at the degrees of freedom.

#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// a(u, phi_i) + (K u, phi_i)_S for every degree of freedom, fixed ones included; incomplete at ghosts.
template <int dim>
[[nodiscard]] std::vector<double> internal_forces(const NitscheForm<dim>& form, std::span<const double> u);

/// L(phi_i) - a(u, phi_i) - (K (u - u_0), phi_i)_S + (t, [phi_i])_C for every degree of freedom; 0 at fixed
/// ones, incomplete at ghosts. t is given at the contact points of the form: T(u), or another traction.
template <int dim>
[[nodiscard]] std::vector<double> residual(const NitscheForm<dim>& form, std::span<const double> u,
                                           std::span<const Point<dim>> t);

/// The same at all degrees of freedom: at fixed ones minus the force of the support.
template <int dim>
[[nodiscard]] std::vector<double> unconstrained_residual(const NitscheForm<dim>& form,
                                                         std::span<const double> u,
                                                         std::span<const Point<dim>> t);

/// (f, u) + (g_N, u)_N.
template <int dim>
[[nodiscard]] double load_work(const NitscheForm<dim>& form, std::span<const double> u);

/// What is lost of g_N - K (u - u_0) on the boundary facet with this number.
template <int dim>
[[nodiscard]] LoadRemainder traction_remainder(const NitscheForm<dim>& form, std::size_t number,
                                               std::span<const double> u);

}  // namespace tribound::contact
