#pragma once

/// @file korn.h
/// A guaranteed constant of Korn's inequality on all bodies, method section 13.5.

#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// K with ||w|| <= K ||eps(w)|| for all w that vanish in the components that Gamma_D fixes; a length. Crude,
/// up to thousands of times the best one: it multiplies what quadrature may miss of the loads. 0 if that is
/// nothing for any degree. Infinite if Gamma_D leaves a body a rigid motion, and for a distributed mesh. K
/// belongs to the bodies, so that it holds on all refinements of the mesh.
template <int dim>
[[nodiscard]] double korn_constant(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh);

}  // namespace tribound::certify
