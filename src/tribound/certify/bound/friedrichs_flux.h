#pragma once

/// @file friedrichs_flux.h
/// The eigenvalue bound for the Friedrichs constant without factorisation; less sharp, for large meshes in
/// 3D.

#include <span>

#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// theta > 0 with theta ||w||^2 <= ||grad w||^2 + sum_{F in C} (1/h_F) ||w||_F^2 for all w that vanish on the
/// fixed facets; 0 if none is found. `means`, one for each facet of the topology, are the facet means of an
/// approximation of phi, -Laplace phi = 1, d_n phi + phi / h_F = 0 on Gamma_C, phi = 0 where fixed. Better
/// means give a larger theta; it is a bound for any means.
///
/// Let q be a field in H(div) with q.n <= 1/h_F on Gamma_C and q.n <= 0 on the rest of the boundary, except
/// where w vanishes. Then
///     0 <= ||grad w + q w||^2 <= ||w||_{C,h}^2 - (div q - |q|^2, w^2),
/// so theta = min(div q - |q|^2) [Protter60]. q = -grad(phi) / (phi + c) in the lowest-order
/// Raviart-Thomas space, with the best of several constants c.
template <int dim>
[[nodiscard]] double flux_theta(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                std::span<const char> fixed, std::span<const double> means);

}  // namespace tribound::certify
