#pragma once

/// @file quantity_parts.h
/// The parts from which numbers of a solution are computed.

#include <span>
#include <string>
#include <vector>

#include "tribound/certify/energy/contact_resultant.h"
#include "tribound/problem/quantity.h"

namespace tribound::certify
{

/// A quantity, with its boundary found on the mesh and its directions known.
template <int dim>
struct QuantityParts
{
  problem::Quantity<dim> quantity;
  int tag = -1;  ///< of the boundary; -1: none, or all in contact
  std::vector<ContactResultant<dim>>
      resultants;                             ///< of forces and moments; safety factors: N, then those of H
  double coefficient = 0;                     ///< mu_F of safety factors
  KnownNumber uplift{};                       ///< U = integral of p_w for safety factors
  Point<dim> direction = Point<dim>::Zero();  ///< e of mean displacements and springs, a unit vector
  double measure = 0;                         ///< of their boundary, on a meridian with the weight r
  std::string note{};                         ///< what else its value depends on
  std::string reason{};                       ///< why it is not a number; empty: it is one
};

/// Throws InputError if a boundary does not exist or is not the contact boundary that is needed, for a safety
/// factor without friction coefficient, and for the direction 0. All ranks together.
template <int dim>
[[nodiscard]] QuantityParts<dim> parts_of(const contact::NitscheForm<dim>& form,
                                          const problem::Quantity<dim>& quantity);

/// The mean of u . e over the boundary of a mean displacement, on a meridian with the weight r.
template <int dim>
[[nodiscard]] double mean_displacement(const contact::NitscheForm<dim>& form, const QuantityParts<dim>& parts,
                                       std::span<const double> u);

/// The integral of t . phi over Gamma_C, both at the contact points.
template <int dim>
[[nodiscard]] double contact_work(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                  std::span<const Point<dim>> phi);

}  // namespace tribound::certify
