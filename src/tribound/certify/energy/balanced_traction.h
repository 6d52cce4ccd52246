#pragma once

/// @file balanced_traction.h
/// Contact tractions that obey the law and balance the bodies that nothing else holds.

#include <optional>
#include <span>

#include "tribound/certify/energy/admissible_traction.h"
#include "tribound/certify/energy/free_motions.h"

namespace tribound::certify
{

/// Of the tractions t_h that admissible_traction() makes, the nearest to t with
///     L(z) + (t_h, [z])_C = 0   for all free motions z,
/// up to 1e-13 of the forces; [z] = z against obstacles. It is t_h(lambda), the nearest to t + sum_i lambda_i
/// [z_i], for some lambda: the minimum of a convex function of lambda, whose gradient is the residual of
/// these conditions, found by Newton's method. On a meridian L and the product have the weight r, and t_h is
/// the nearest in the plane to t + sum_i lambda_i r [z_i]. On a mesh with free motions it is absent if
/// Newton's method finds none, for example if loads pull a body off its obstacle. All ranks together.
template <int dim>
[[nodiscard]] std::optional<AdmissibleTraction<dim>> balanced_traction(const contact::NitscheForm<dim>& form,
                                                                       const FreeMotions<dim>& motions,
                                                                       std::span<const Point<dim>> t);

}  // namespace tribound::certify
