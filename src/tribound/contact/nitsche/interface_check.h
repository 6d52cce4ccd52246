#pragma once

/// @file interface_check.h
/// The conditions that interfaces with a bond impose on mesh and data (method section 12.1).

#include <memory>
#include <optional>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// Where gamma is nearest to the softening slope of a law.
struct SofteningMargin
{
  double ratio = 0;         ///< slope / gamma: below 1 the resolvent is unique; 0 without softening
  std::size_t segment = 0;  ///< number of the segment on this process
};

/// Over the segments of this process, or only those of the boundary `tag` if it is given.
template <int dim>
[[nodiscard]] SofteningMargin softening_margin(const NitscheForm<dim>& form, std::optional<int> tag = {});

/// What the contact points remember before the first step: fresh states, except for bonds where
/// Contact::broken is not 0. Null if there are none. All ranks together.
template <int dim>
[[nodiscard]] std::shared_ptr<const ContactHistory<dim>> history_at_first(const NitscheForm<dim>& form);

/// Throws InputError and names the place: if the constants of a law are inconsistent (problem::fault); if
/// slope >= gamma, with the facet size that would do; if there is a gap under a bond; if gamma_t is not gamma
/// and the direction of contact varies or gamma_0 is too small for it; and for a pair with water whose slave
/// is not covered. Also throws what check_interface_data() throws. All ranks together.
template <int dim>
void check_interfaces(const NitscheForm<dim>& form);

/// For every load step, because data depend on t. Throws InputError if gap, threshold or water pressure of a
/// softening law are not piecewise polynomials: T is then not Lipschitz continuous in them with the constant
/// 1. All ranks together.
template <int dim>
void check_interface_data(const NitscheForm<dim>& form);

}  // namespace tribound::contact
