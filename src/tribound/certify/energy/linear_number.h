#pragma once

/// @file linear_number.h
/// A number that is linear in the solution, with what is needed to bound it on one mesh.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/certify/energy/contact_weight.h"
#include "tribound/certify/energy/dual_problem.h"
#include "tribound/certify/energy/linear_bound.h"
#include "tribound/certify/energy/quantity_parts.h"

namespace tribound::certify
{

/// Q = l(u) + (sigma(u) n, phi)_C.
template <int dim>
struct LinearNumber
{
  std::optional<KnownNumber> known{};          ///< from equilibrium: then nothing else is needed
  std::vector<Point<dim>> phi{};               ///< at the contact points of the form of u
  std::optional<ContactWeight<dim>> weight{};  ///< phi on the form of the bounds
  std::unique_ptr<DualProblem<dim>> loads{};   ///< with the loads l; null: none

  /// l(v) + (t_h, phi)_C. All ranks together.
  [[nodiscard]] double base(const BoundedState<dim>& state, const QuantityParts<dim>& parts) const;
};

/// A contact force or moment that equilibrium does not give, on the forms of u and of the bounds; returns the
/// reason if there is no weight. All ranks together.
template <int dim>
[[nodiscard]] std::string set_weight(LinearNumber<dim>& number, const contact::NitscheForm<dim>& form,
                                     const contact::NitscheForm<dim>& bounded,
                                     const ContactWeights<dim>& weights,
                                     const ContactResultant<dim>& resultant, double ramp);

/// A mean displacement, the work of the loads or the force of a spring. All ranks together.
template <int dim>
[[nodiscard]] LinearNumber<dim> loaded_number(const QuantityParts<dim>& parts,
                                              const contact::NitscheForm<dim>& bounded);

}  // namespace tribound::certify
