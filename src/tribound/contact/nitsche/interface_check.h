#pragma once

/// @file interface_check.h
/// What interfaces with a bond ask of mesh and data (method section 12.1).

#include <memory>
#include <optional>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// Where gamma comes nearest to the slope with which a law softens.
struct SofteningMargin
{
  double ratio = 0;         ///< slope / gamma: below 1 the resolvent is unique; 0 where nothing softens
  std::size_t segment = 0;  ///< number of the segment, on this process
};

/// Over the segments of this process, those of the boundary `tag` alone where it is given.
template <int dim>
[[nodiscard]] SofteningMargin softening_margin(const NitscheForm<dim>& form, std::optional<int> tag = {});

/// What the contact points remember before the first step: fresh, but for bonds where Contact::broken is not
/// 0. Null where there are none. All ranks together.
template <int dim>
[[nodiscard]] std::shared_ptr<const ContactHistory<dim>> history_at_first(const NitscheForm<dim>& form);

/// Throws InputError, naming the place: where the constants of a law do not go together (problem::fault);
/// where slope >= gamma, with the facet size that would do; where there is a gap under a bond; where gamma_t
/// is not gamma and the direction of contact varies, or gamma_0 is too small for it; and for a pair with
/// water of which the slave is not covered. What check_interface_data() throws, too. All ranks together.
template <int dim>
void check_interfaces(const NitscheForm<dim>& form);

/// Of every load step, as data follow t: throws InputError where gap, threshold or water pressure of a law
/// that softens are no polynomials on pieces, of which T is not Lipschitz continuous with the constant 1. All
/// ranks together.
template <int dim>
void check_interface_data(const NitscheForm<dim>& form);

}  // namespace tribound::contact
