#pragma once

/// @file random_meridian_bound.h
/// The bound of random bodies of revolution against the dual norm of the residual.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>
#include <string>

#include "support/meridian_problem.h"
#include "support/random_cases.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

/// A converged iterate with its bound and the dual norm below it.
struct BoundedMeridian
{
  const MeridianProblem& problem;
  const solve::NewtonResult<2>& newton;
  const certify::Stress<2>& stress;
  const certify::Estimate& eta;
  double below;
  std::string name;
};

/// make_problem(random, inner): for random_meridian(inner, ...), on the axis and off it, p = 1 to 3; the
/// bound after one step of Newton's method, two and all of them. Calls at_end() with the last.
template <class MakeProblem, class AtEnd>
void expect_above_dual_norm_of_random(const MakeProblem& make_problem, const AtEnd& at_end)
{
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
  {
    std::mt19937 random(seed);
    const double inner = seed % 2 == 0 ? 0 : 0.05 + 0.1 * (seed % 5);
    const int p = 1 + static_cast<int>(seed / 2) % 3;
    MeridianProblem c(random_meridian(inner, 2 + static_cast<int>(random() % 3), seed),
                      make_problem(random, inner), {.degree = p, .newton = {.tolerance = 1e-11}});
    certify::DualNorm<2> dual_norm(c.form, {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
    std::string line = fmt::format("seed {}: p = {}, inner = {}", seed, p, inner);
    const int all_steps = c.method.newton.max_steps;
    for (const int steps : {1, 2, all_steps})
    {
      c.method.newton.max_steps = steps;
      const solve::NewtonResult<2> newton = c.solve();
      const double below = dual_norm(newton.u);
      const certify::Stress<2> stress = certify::equilibrate<2>(c.form, newton.u, newton.traction);
      const certify::Estimate eta = certify::estimate<2>(c.form, newton.u, stress);
      EXPECT_GE(eta.total_sharp, below) << line;
      line += fmt::format("  k = {:<2} {:.4f}", newton.steps.size(), eta.total_sharp / below);
      if (steps == all_steps) at_end(BoundedMeridian{c, newton, stress, eta, below, line});
    }
    std::cout << line << std::endl;
  }
}

}  // namespace tribound::test
