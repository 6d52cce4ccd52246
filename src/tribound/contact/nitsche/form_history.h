#pragma once

/// @file form_history.h
/// Contact histories as functions on the segments of a form.

#include <memory>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// The history of the form with the polynomials that have these values at its contact points. They are cut to
/// what the laws admit and, where the direction of contact varies, to the tangent plane.
template <int dim>
[[nodiscard]] std::shared_ptr<const ContactHistory<dim>> history_from_values(
    const NitscheForm<dim>& form, std::vector<problem::InterfaceState<dim>> values);

/// The history of `from`, which has one, as the same function for a form of higher degree on its segments.
template <int dim>
[[nodiscard]] std::shared_ptr<const ContactHistory<dim>> raised_history(const NitscheForm<dim>& from,
                                                                        const NitscheForm<dim>& to);

}  // namespace tribound::contact
