/// @file interval_agreement_test.cpp
/// Intervals of every iterate and of a richer solution agree, as `tribound verify` requires; wrong ones do
/// not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tribound/certify/energy/interval_comparison.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/nitsche/penalty.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

/// The intervals of both solutions agree at every iterate; an interval shifted beyond the other does not.
template <int dim>
void expect_agreement(unsigned seed, int p)
{
  RandomCase<dim> block_of{std::mt19937(seed)};
  const ProblemData<dim> data = block_of.data();
  DiscreteProblem<dim> c(block_of.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-11}});
  const Asked<dim> asked(block_of.is_held_above);
  const EnergyEstimator<dim> estimator(c.form, c.method.solver, asked.quantities);
  std::vector<EnergyBound> bounds;
  const auto bound_iterate = [&](const solve::NewtonIterate<dim>& iterate)
  {
    bounds.push_back(estimator(iterate.u()));
    return solve::NewtonAdvice(false);
  };
  const std::vector<double> u = c.solve(0, bound_iterate).u;
  EnergyBound of_richer{.reason = "not computed"};
  const auto bound_richer = [&](const contact::NitscheForm<dim>& form, std::span<const double> richer_u)
  { of_richer = EnergyEstimator<dim>(form, c.method.solver, asked.quantities)(richer_u); };
  const certify::RicherSolution richer = certify::compare_with_richer<dim>(
      c.form, u, {.refinements = 1, .degree = std::min(p + 1, 4)},
      contact::default_gamma0(std::min(p + 1, 4)), c.method.newton, c.method.solver, bound_richer);
  ASSERT_TRUE(richer.error) << richer.failure;
  ASSERT_EQ(of_richer.reason, "");
  for (EnergyBound& bound : bounds)
    for (std::size_t i = 0; i < bound.quantities.size(); ++i)
    {
      QuantityInterval& interval = bound.quantities[i];
      const QuantityInterval& other = of_richer.quantities[i];
      const auto agree = [&] { return certify::compare_intervals(bound, interval, of_richer, other).agree; };
      EXPECT_EQ(agree(), true) << interval.name << ", seed " << seed;
      const double beyond = other.upper - interval.lower + 0.1 * (interval.upper - interval.lower);
      interval.lower += beyond;
      interval.upper += beyond;
      EXPECT_EQ(agree(), false) << interval.name << ", seed " << seed;
    }
}

TEST(IntervalAgreement, IntervalsOfARicherSolutionAgree)
{
  for (unsigned seed = 100; seed < 100 + n_cases(4); ++seed)
    expect_agreement<2>(seed, 1 + static_cast<int>(seed % 4));
  for (unsigned seed = 200; seed < 200 + n_cases(1); ++seed) expect_agreement<3>(seed, 1);
}

}  // namespace

}  // namespace tribound::test
