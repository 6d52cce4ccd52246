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

/// Calls solve(), first with method.full_steps full steps. Without method.other_starts it tries nothing else.
/// In 3D a start from scratch goes through easier problems on the same mesh. With degree p >= 2 this is the
/// problem with degree p / 2, rounded up, solved to a relative residual of 1e-4 and started likewise: most
/// steps then cost a fraction. With degree 1, on a mesh with some 16 facets across the contact boundary or
/// more, it is the problem with a third of gamma, solved to 0.1 and started likewise, beginning with the
/// gamma of a mesh with a single facet there: fewer steps then lead to the contact state. It is skipped if
/// the first step shows that nearly all facets are closed and sticking. Where all this fails, with damping
/// and contact and without [regularisation], other starts follow: from scratch, from solutions with T_delta,
/// which has no kinks, in place of T, for decreasing delta, then from those with three times and with a third
/// of gamma. Near incompressibility Newton's method may cycle between contact states, and these starts lead
/// it out. `equilibrium`: of the form, if one already exists. The steps of these solutions go to `record`,
/// those of all attempts to `observer`. If all attempts fail, the first failure is reported.
template <int dim>
[[nodiscard]] solve::NewtonResult<dim> solve_persistently(
    const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const solve::NewtonObserver<dim>& observer, double delta,
    const std::function<void(const solve::NewtonStep&)>& record,
    std::shared_ptr<solve::Equilibrium<dim>> equilibrium = {});

}  // namespace tribound::adapt
