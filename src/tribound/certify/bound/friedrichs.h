#pragma once

/// @file friedrichs.h
/// A guaranteed upper bound of the Friedrichs constant of a mesh and its boundary conditions: it bounds a
/// function by its gradient and its trace on Gamma_C.

#include "tribound/base/types.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// C_F^2 = 1/theta + kappa^2 H^2 with kappa < 0.3 in 2D, 0.34 in 3D.
struct FriedrichsConstant
{
  double value;      ///< C_F, a length
  double theta;      ///< the smallest over all components
  double mesh_size;  ///< H, the largest h_T of the mesh of the proof; 0 if the proof needs none
  Index cells;       ///< of the mesh of the proof
  /// K of korn.h where quadrature may miss a part of the loads; else 0.
  double korn = 0;
};

/// kappa with ||w - I w||_T <= kappa h_T ||grad(w - I w)||_T, I w the Crouzeix-Raviart interpolant [CGR12].
template <int dim>
[[nodiscard]] double friedrichs_kappa();

/// With more cells than this the proof uses no factorisation, nor a refined mesh. For a cube of Kuhn's
/// tetrahedra, one component, seconds of a core with factors and without: 105 000 cells 10 and 1.4; 304 000
/// cells 40 and 6, where the factors take 1.8 GB and the rest 0.35. The constant without them was 1.4 times
/// as large; it multiplies small numbers.
inline constexpr Index most_cells_factorised = 20'000;

/// C_F with ||v|| <= C_F ||v||_{C,h} for all v that vanish in the components that Gamma_D fixes,
///     ||v||_{C,h}^2 = ||grad v||^2 + sum_{F in C} (1/h_F) ||v||_F^2 + sum_k (1/h_k) ||[v]||_k^2,
/// where C are the obstacles and springs and k the segments of pairs; on this mesh and on all its
/// refinements, whose h_F and h_k are not larger. Pairs count if a body needs them (friedrichs_pairs.h).
/// Infinite (and theta = 0) if joined bodies have a component with neither Gamma_D nor C, which
/// check_rigid_motions() refuses as a free translation, and if no theta could be proved. If the factorisation
/// fails, for example for lack of memory, the proof without it is used, too. Infinite for a distributed mesh:
/// the constant of the undistributed mesh is known before. So is K. For axisymmetric problems as
/// meridian_friedrichs(), with theta = 1 / C_F^2 and without K.
template <int dim>
[[nodiscard]] FriedrichsConstant friedrichs_constant(const problem::Problem<dim>& problem,
                                                     const mesh::Mesh<dim>& mesh,
                                                     Index most_factorised = most_cells_factorised);

}  // namespace tribound::certify
