#pragma once

/// @file process_zone.h
/// Steps that open and slip the zone damaged by the previous step (method section 12.7).

#include <optional>
#include <span>

#include "tribound/adapt/load_path.h"

namespace tribound::adapt
{

/// C(u) = c.u: the product of the jump of u with its last change, integrated where the last step has damaged
/// a bond, over that of this change with itself. The last step has thus increased C by 1. `form` and
/// `responses` are those of that step. Absent where it has damaged nothing. All ranks call it together.
template <int dim>
[[nodiscard]] std::optional<PathMeasure<dim>> zone_measure(
    const contact::NitscheForm<dim>& form, std::span<const problem::InterfaceResponse<dim>> responses,
    std::span<const double> u_before, std::span<const double> u);

/// A step by zone_measure() that replaces a failed step under `control`, by the damage. Damage cannot be
/// prescribed where a crack grows by the increasing pressure in it alone; this functional can. It grows by
/// the ratio of the intended damage to that of the last step, and by at most 2. Returns whether there is such
/// a step; false where the last step has damaged nothing.
template <int dim>
[[nodiscard]] bool follow_zone(LoadPath<dim>& path, const Control<dim>& control,
                               const typename LoadPath<dim>::Observer& observer, const StepObserver& newton);

/// The fraction of all bonded interfaces that is open or slips. All ranks call it together.
template <int dim>
[[nodiscard]] double moving_share(const LoadStep<dim>& step);

}  // namespace tribound::adapt
