#pragma once

/// @file meridian_distances.h
/// The distances of cell_distances.h and the products of dual_products.h for axisymmetric problems of degree
/// p; stresses tau_h = r sigma_h have degree p + 1. Integrals have the weight r.

#include <span>

#include "tribound/certify/energy/cell_distances.h"
#include "tribound/certify/energy/dual_products.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// All are upper bounds.
[[nodiscard]] CellDistances meridian_distances(const contact::NitscheForm<2>& form, const Stress<2>& stress,
                                               std::span<const double> u, std::span<const double> v);

/// Squares are upper bounds; `doubt` of the result says how far the others may be off.
[[nodiscard]] DualProducts meridian_products(const contact::NitscheForm<2>& form, const Stress<2>& stress,
                                             std::span<const double> v, const DualPair<2>& pair);

}  // namespace tribound::certify
