#pragma once

/// @file weak_symmetry_testing.h
/// Displacements of axisymmetric problems in equilibrium with a contact traction, for tests of the weakly
/// symmetric stress.

#include <algorithm>
#include <vector>

#include "tribound/certify/energy/edge_moments.h"
#include "tribound/certify/energy/elastic_system.h"
#include "tribound/certify/energy/meridian_edge_forces.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "unit/certify/meridian_testing.h"

namespace tribound::test
{

struct Equilibrium
{
  std::vector<double> u;
  std::vector<Point<2>> t;
};

/// The axial force of loads at nodes.
inline double axial_force(std::span<const double> loads)
{
  double sum = 0;
  for (std::size_t i = 1; i < loads.size(); i += 2) sum += loads[i];
  return sum;
}

/// Whether a boundary of the problem fixes the axial component.
inline bool is_held(const MeridianProblem& c)
{
  return std::ranges::any_of(c.mesh.boundary(), [&](const mesh::BoundaryFacet& facet)
                             { return c.problem.boundary(facet.tag).fixes(1); });
}

/// u for the traction t, of which a constant is subtracted where nothing else holds the body.
inline Equilibrium in_equilibrium(const MeridianProblem& c, std::vector<Point<2>> t)
{
  const auto loads = [&](std::span<const Point<2>> traction)
  {
    std::vector<double> result(c.form.load().begin(), c.form.load().end());
    c.form.add_contact_load(traction, result);
    return result;
  };
  std::vector<Index> supports;
  if (!is_held(c))
  {
    const std::vector<Point<2>> none(t.size(), Point<2>::Zero());
    const std::vector<Point<2>> unit(t.size(), Point<2>::UnitY());
    for (int pass = 0; pass < 2; ++pass)
    {
      const double shift = axial_force(loads(t)) / (axial_force(loads(unit)) - axial_force(loads(none)));
      for (Point<2>& at_point : t) at_point[1] -= shift;
    }
    supports = {1};
  }
  std::vector<double> start(c.space.n_dofs(), 0.0);
  c.form.prescribe(start);
  const certify::ElasticSystem<2> system(c.problem, c.space, c.form.constraints().fixed, c.method.solver, {},
                                         supports);
  return {system.solve(loads(t), system.solve(loads(t), start, 1e-13), 1e-13), t};
}

/// The weakly symmetric stress of u and t.
inline certify::Stress<2> weakly_symmetric(const MeridianProblem& c, const Equilibrium& state,
                                           int n_threads = 0)
{
  std::vector<Tensor<2>> turning;
  if (c.space.degree() == 1)
    turning = certify::edge_moments<2>(c.mesh, certify::meridian_edge_forces(c.form, state.u, state.t));
  return certify::Equilibrator<2>(c.form, certify::PatchStress::afw_compliance, n_threads)
      .balanced(state.u, state.t, turning);
}

}  // namespace tribound::test
