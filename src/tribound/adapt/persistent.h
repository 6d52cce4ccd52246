#pragma once

/// @file persistent.h
/// Newton's method with more than one start.

#include <functional>
#include <memory>
#include <span>

#include "tribound/adapt/method.h"
#include "tribound/solve/newton.h"

namespace tribound::adapt
{

/// solve(), at first with method.full_steps full steps; without method.other_starts no more. From scratch in
/// 3D by way of easier problems on the same mesh. With degree p >= 2 that is the one with degree p / 2,
/// rounded up, solved to a relative residual of 1e-4 and found likewise: most steps then cost a fraction.
/// With degree 1, on a mesh with some 16 facets across the contact boundary or more, it is the one with a
/// third of gamma, solved to 0.1 and found likewise, from gamma of a mesh with a single facet there on,
/// unless the first step shows that nearly all facets are closed and sticking: fewer steps lead to the
/// contact state. Where that fails, with damping and contact and without [regularisation], from other starts:
/// from scratch, from solutions with T_delta in the place of T, which has no kinks, for smaller and smaller
/// delta, then from those with three times and with a third of gamma. Near incompressibility Newton's method
/// may go round in circles between contact states, and finds its way from there. `equilibrium`: of the form,
/// where there is one already. The steps of these solutions
/// go to `record`, those of all attempts to `observer`. Should all fail, it is the first one that is told of.
template <int dim>
[[nodiscard]] solve::NewtonResult<dim> solve_persistently(
    const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const solve::NewtonObserver<dim>& observer, double delta,
    const std::function<void(const solve::NewtonStep&)>& record,
    std::shared_ptr<solve::Equilibrium<dim>> equilibrium = {});

}  // namespace tribound::adapt
