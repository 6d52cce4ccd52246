#pragma once

/// @file too_flat.h
/// The message where rounding leaves no equilibrated stress.

#include "tribound/base/error.h"
#include "tribound/certify/equilibrate/sorted_cell.h"

namespace tribound::certify
{

/// The longest edge over the smallest height.
template <int dim>
[[nodiscard]] double slenderness(const SortedCell<dim>& cell);

/// What to throw where a matrix that should be positive definite is not: the place, and why.
template <int dim>
[[nodiscard]] SolveError no_equilibrated_stress(const Point<dim>& place, double slenderness);

}  // namespace tribound::certify
