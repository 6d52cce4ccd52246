#pragma once

/// @file contact_hold.h
/// How contact may explain a failure of Newton's method, as text appended to the error message.

#include <string>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::adapt
{

/// Says that a body held by contact alone may have lost it. Empty where displacement conditions hold every
/// body, or ties may. All ranks call it together.
template <int dim>
[[nodiscard]] std::string words_of_hold(const contact::NitscheForm<dim>& form);

/// Says that contact cannot balance the loads of the problem, which are those at t, whatever its pressures
/// are (contact::why_not_held()). Empty where it may, or where this is not known, as on several ranks.
template <int dim>
[[nodiscard]] std::string words_of_statics(const problem::Problem<dim>& problem,
                                           const fem::LagrangeSpace<dim>& space, double t);

}  // namespace tribound::adapt
