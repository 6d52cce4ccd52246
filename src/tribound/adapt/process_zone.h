#pragma once

/// @file process_zone.h
/// Steps along which the zone that the last one has damaged opens and slips on (method section 12.7).

#include <optional>
#include <span>

#include "tribound/adapt/load_path.h"

namespace tribound::adapt
{

/// C(u) = c.u, the work of the jump of u with its last change where the last step has damaged a bond, over
/// that of this change with itself: the last step has added 1 to it. `form` and `responses` are those of that
/// step. Absent where it has damaged nothing. All ranks together.
template <int dim>
[[nodiscard]] std::optional<PathMeasure<dim>> zone_measure(
    const contact::NitscheForm<dim>& form, std::span<const problem::InterfaceResponse<dim>> responses,
    std::span<const double> u_before, std::span<const double> u);

/// A step by zone_measure() in place of one under `control`, by the damage, which has failed: damage cannot
/// be given where a crack damages more by the growth of the pressure in it alone, and this functional can. It
/// grows by as much, over the last step, as the damage should have, and by at most twice of that. Whether
/// there is one; false where the last step has damaged nothing.
template <int dim>
[[nodiscard]] bool follow_zone(LoadPath<dim>& path, const Control<dim>& control,
                               const typename LoadPath<dim>::Observer& observer, const StepObserver& newton);

/// The share of all interfaces with a bond that is open or slips. All ranks together.
template <int dim>
[[nodiscard]] double moving_share(const LoadStep<dim>& step);

}  // namespace tribound::adapt
