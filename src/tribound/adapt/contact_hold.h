#pragma once

/// @file contact_hold.h
/// What contact may have to do with a failure of Newton's method, in words that follow its message.

#include <string>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::adapt
{

/// That a body which contact alone holds may have lost it; empty where displacement conditions hold every
/// body, or ties may. All ranks together.
template <int dim>
[[nodiscard]] std::string words_of_hold(const contact::NitscheForm<dim>& form);

/// That contact cannot balance the loads of the problem, which are those at t, whatever its pressures are
/// (contact::why_not_held()); empty where it may, or nobody knows, as on several ranks.
template <int dim>
[[nodiscard]] std::string words_of_statics(const problem::Problem<dim>& problem,
                                           const fem::LagrangeSpace<dim>& space, double t);

}  // namespace tribound::adapt
