#pragma once

/// @file friedrichs_potential.h
/// An approximate potential, from which the Friedrichs constant is proved without factorisation.

#include <span>
#include <vector>

#include "tribound/certify/bound/eigenvalue_bound.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// Facet means of phi with A phi = M 1, approximately, >= 0; `pencil` has A and M for Crouzeix-Raviart
/// functions that vanish on the fixed facets. Conjugate gradients with diagonal preconditioning start from
/// the solution in the continuous functions of degree 1, which have far fewer unknowns: then only what
/// oscillates from cell to cell is left.
template <int dim>
[[nodiscard]] std::vector<double> potential_means(const problem::Problem<dim>& problem,
                                                  const mesh::Mesh<dim>& mesh, std::span<const char> fixed,
                                                  Pencil pencil);

}  // namespace tribound::certify
