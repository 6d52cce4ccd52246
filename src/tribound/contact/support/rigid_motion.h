#pragma once

/// @file rigid_motion.h
/// Whether the boundary conditions hold every body. A motion that nothing stops is an error of the case and
/// is named before a factorisation fails on it.

#include <span>
#include <string>

#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// Throws InputError naming the bodies and the motion if an assembly (bodies joined by pairs, or a single
/// one)
///  * can move rigidly although its displacement conditions hold and all contact is closed (and sticking,
///    where there is friction): the first Newton step would be singular; or
///  * is driven by its loads into a rigid motion that contact, which only pushes and whose friction is
///    limited, cannot resist: there is no solution. There is one only if L(z) <= (s, |[z]^t|)_C for every
///    rigid motion z, one of each body, with [z] = 0 on ties, [z]^n <= 0 on frictionless and Tresca contact
///    and [z]^n + mu_F |[z]^t| <= 0 on Coulomb contact, where (s, .) is over Tresca contact: take z as test
///    function. Exact up to rounding, except that integrals of loads and of s |[z]^t| allow for their
///    quadrature error. So what is refused has no solution, but some cases without one pass.
/// Bodies that displacement conditions alone hold pass at once. The mesh is a whole one: before its
/// distribution or later, since refinement changes neither bodies nor supports. `load` is L(phi_i) for every
/// degree of freedom, up to the remainders of the data of the form.
template <int dim>
void check_rigid_motions(const NitscheForm<dim>& form, std::span<const double> load);

/// The same with the load of the form.
template <int dim>
void check_rigid_motions(const NitscheForm<dim>& form)
{
  check_rigid_motions(form, form.load());
}

/// The message of that error, also for invalid data; empty: no error. The mesh is a whole one.
template <int dim>
[[nodiscard]] std::string why_not_held(const problem::Problem<dim>& problem,
                                       const fem::LagrangeSpace<dim>& space);

/// The same from the mesh alone.
template <int dim>
void check_rigid_motions(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree);

}  // namespace tribound::contact
