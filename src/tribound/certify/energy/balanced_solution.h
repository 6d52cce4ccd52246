#pragma once

/// @file balanced_solution.h
/// The discrete solution with a given contact traction.

#include <span>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/certify/energy/contact_systems.h"
#include "tribound/certify/energy/free_motions.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// The same function in a space of higher degree on the same mesh: values at its nodes.
template <int dim>
[[nodiscard]] std::vector<double> raised(const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                                         const fem::LagrangeSpace<dim>& richer);

/// u~ in `space` with a(u~, v) = L(v) + (t, [v])_C for all v of it, as degrees of freedom of the space of
/// `rich`, which contains it and has the load and the contact points. The residual is 1e-12 of the forces, up
/// to rounding. Starts from `start`, which has the values of the fixed degrees of freedom. Load and t must do
/// no work in the free motions. Of the solutions, which differ by these, the one is taken that leaves
/// FreeMotions::supports() as they are in `start`. `systems` are those of `rich`.
template <int dim>
[[nodiscard]] std::vector<double> balanced_solution(
    const contact::NitscheForm<dim>& rich, const fem::LagrangeSpace<dim>& space,
    std::span<const double> start, std::span<const Point<dim>> t, const FreeMotions<dim>& motions,
    const algebra::SolverOptions& solver, ContactSystems<dim>& systems);

}  // namespace tribound::certify
