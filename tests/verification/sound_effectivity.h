#pragma once

/// @file sound_effectivity.h
/// The bound at the solution over the dual norm, once its identities are checked.

#include <gtest/gtest.h>

#include "support/discrete_problem.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

/// Identities, and the bound above the dual norm at the last iterate.
template <int dim>
double sound_effectivity(const DiscreteProblem<dim>& c)
{
  const solve::NewtonResult<dim> newton = c.solve();
  const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, newton.u, newton.traction);
  EXPECT_LE(certify::check_identities<dim>(c.form, newton.traction, stress).largest(), 1e-9);
  const double eta =
      certify::Estimator<dim>(c.form, certify::ContactRule::resolved)(newton.u, stress).total_sharp;
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = dim == 2 ? 2 : 1, .degree = c.space.degree() + 2});
  return eta / dual_norm(newton.u);
}

}  // namespace tribound::test
