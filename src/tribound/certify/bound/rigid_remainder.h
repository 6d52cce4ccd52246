#pragma once

/// @file rigid_remainder.h
/// What the equilibrated stress lacks of the forces on rigid parts, method section 17.

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// eta with |F(v) - (sigma_h n, v)_S| <= eta ||v||_{C,h} for all v that are rigid motions on each part, F(v)
/// the work of the given forces and moments: ||tau|| + C_F ||div tau||, tau n the rigid motion on S with the
/// resultants that are missing, 0 on all other facets. `friedrichs`: C_F; if it is infinite, eta is 0 where
/// nothing but rounding is missing, else infinite. All ranks together.
template <int dim>
[[nodiscard]] double rigid_remainder(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                                     double friedrichs);

/// The largest part of the forces on a rigid part that the stress does not carry, relative to all of them.
template <int dim>
[[nodiscard]] double rigid_defect(const contact::NitscheForm<dim>& form, const Stress<dim>& stress);

}  // namespace tribound::certify
