/// @file two_bodies_effectivity_test.cpp
/// The bound against the dual norm of the residual for bodies in contact: random meshes, shapes, materials,
/// laws and gaps, at the first iterates and the last.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/discrete_problem.h"
#include "support/random_pair.h"
#include "support/seen_range.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

namespace
{

/// The observed quotients of bound and dual norm.
struct Seen
{
  SeenRange converged;
  SeenRange others;
};

/// At a random iterate of the first three, and at the last.
template <int dim>
void expect_above_dual_norm(unsigned seed, int degree, Seen& seen)
{
  RandomPair<dim> random(seed);
  auto [data, problem] = random.make();
  adapt::Method method{.degree = degree};
  method.gamma0 = contact::default_gamma0(degree) * std::pow(10.0, random.within(0, 1));
  method.newton.damping = true;
  method.newton.max_steps = 40;
  const DiscreteProblem<dim> c(std::move(data), problem, method);
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = dim == 2 ? 2 : 1, .degree = degree + 2});
  const int early = 1 + random.pick(3);
  const certify::Estimator<dim> estimator(c.form, certify::ContactRule::resolved);
  const auto check = [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    if (!iterate.converged && iterate.step.step != early) return false;
    const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, iterate.u(), iterate.traction);
    EXPECT_LE(certify::check_identities<dim>(c.form, iterate.traction, stress).largest(), 1e-9) << seed;
    const double eta = estimator(iterate.u(), stress).total_sharp;
    const double below = dual_norm(iterate.u());
    EXPECT_GE(eta, below) << seed << ", step " << iterate.step.step;
    (iterate.converged ? seen.converged : seen.others).add(eta / below);
    return false;
  };
  (void)c.solve(0, check);
}

void report(int dim, int degree, const Seen& seen)
{
  fmt::print("{}D, p = {}: {} converged {:.3f} to {:.3f}, {} others {:.3f} to {:.3f}\n", dim, degree,
             seen.converged.count, seen.converged.least, seen.converged.most, seen.others.count,
             seen.others.least, seen.others.most);
}

class RandomPairs2D : public ::testing::TestWithParam<int>
{
};

TEST_P(RandomPairs2D, TheBoundIsAboveTheDualNorm)
{
  const int degree = GetParam();
  const int n_cases = degree == 1 ? 70 : degree == 2 ? 70 : degree == 3 ? 30 : 10;
  Seen seen;
  for (int i = 0; i < n_cases; ++i)
    expect_above_dual_norm<2>(static_cast<unsigned>(1000 * degree + i), degree, seen);
  report(2, degree, seen);
  EXPECT_GE(seen.converged.count, n_cases * 9 / 10);
  EXPECT_LE(seen.converged.most, 2);  // it was 1.11 to 1.97, three of 180 above 1.8
}

INSTANTIATE_TEST_SUITE_P(Degrees, RandomPairs2D, ::testing::Range(1, 5));

/// On meshes of one or two cells in height, which resolve the stress poorly.
TEST(RandomPairs3D, TheBoundIsAboveTheDualNorm)
{
  for (const auto& [degree, n_cases] : {std::pair(1, 16), {2, 3}})
  {
    Seen seen;
    for (int i = 0; i < n_cases; ++i)
      expect_above_dual_norm<3>(static_cast<unsigned>(500 * degree + i), degree, seen);
    report(3, degree, seen);
    EXPECT_GE(seen.converged.count, n_cases * 9 / 10);
    EXPECT_LE(seen.converged.most, 4.5);  // it was 1.11 to 4.12
  }
}

}  // namespace

}  // namespace tribound::test
