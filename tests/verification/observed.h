#pragma once

/// @file observed.h
/// Solutions as the output reads them.

#include <algorithm>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/adapt/level.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/io/fields/tensor_field.h"

namespace tribound::test
{

/// The solution of Newton's method with its stress, as much as probes and sections use of a level.
template <int dim>
adapt::CertifiedLevel<dim> observed(const DiscreteProblem<dim>& c, certify::PatchStress stress)
{
  const solve::NewtonResult<dim> solved = c.solve();
  adapt::CertifiedLevel<dim> level;
  level.u = solved.u;
  level.traction = solved.traction;
  level.stress = certify::equilibrate<dim>(c.form, solved.u, solved.traction, 0, 0, stress);
  return level;
}

/// The node at a vertex of the mesh.
template <int dim>
Index corner(const DiscreteProblem<dim>& c, const Point<dim>& vertex)
{
  const std::vector<Point<dim>> nodes = c.space.node_points();
  return static_cast<Index>(std::ranges::find(nodes, vertex) - nodes.begin());
}

}  // namespace tribound::test
