#pragma once

/// @file energy_interval.h
/// The interval of a(u, u).

#include "tribound/certify/energy/linear_bound.h"
#include "tribound/certify/energy/quantity_interval.h"

namespace tribound::certify
{

/// Whether u_D = 0, g = 0 and w = 0, between bodies too. All ranks together.
template <int dim>
[[nodiscard]] bool is_homogeneous(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets);

/// Sets the interval of a(u, u): with m = (tau + sigma(v))/2
///     | ||u||_en - ||m|| | <= mid,
/// and for a homogeneous problem ||tau||^2 + 2 remainder(v) + [-2E, 2 ||O|| B_v]. All ranks together.
template <int dim>
void set_energy(const BoundedState<dim>& state, bool is_homogeneous, QuantityInterval& interval);

}  // namespace tribound::certify
