#pragma once

/// @file path_bound.h
/// The bound of a load step against the dual norm of the residual.

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "support/bonded_path.h"
#include "support/seen_range.h"
#include "tribound/adapt/load_path.h"
#include "tribound/adapt/transfer.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

/// Repeats the step from the displacement before it, with the bound of each of its first iterates.
template <int dim>
void expect_above_dual_norm(const adapt::LoadStep<dim>& step, std::span<const double> before, SeenRange& seen)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const int degree = form.space().degree();
  certify::DualNorm<dim> dual_norm(
      form, {.refinements = dim == 2 ? 2 : 1, .degree = dim == 2 ? degree + 2 : degree + 1});
  const certify::Estimator<dim> estimator(form, certify::ContactRule::resolved);
  const auto check = [&](std::span<const double> u, std::span<const Point<dim>> traction)
  {
    const certify::Stress<dim> stress = certify::equilibrate<dim>(form, u, traction);
    EXPECT_LE(certify::check_identities<dim>(form, traction, stress).largest(), 1e-9);
    const double bound = estimator(u, stress).total_sharp;
    const double below = dual_norm(u);
    EXPECT_GE(bound, below);
    seen.add(bound / below);
  };
  const solve::NewtonOptions options{.max_steps = 2, .damping = false};
  (void)solve::solve<dim>(form, before, options, {},
                          [&](const solve::NewtonIterate<dim>& iterate)
                          {
                            check(iterate.u(), iterate.traction);
                            return false;
                          });
  check(step.level.u, step.level.traction);
}

/// On meshes to which the history is transferred in the middle of path_of_t.
template <int dim>
void expect_above_dual_norm_after_transfer(adapt::LoadPath<dim>& path, SeenRange& seen)
{
  for (const double t : {path_of_t[0], path_of_t[1]}) ASSERT_EQ(path.advance(t), "");
  std::vector<double> before;
  const auto check = [&](const adapt::LoadStep<dim>& step)
  {
    if (before.empty()) before = step.start;
    expect_above_dual_norm<dim>(step, before, seen);
    before = step.level.u;
  };
  const certify::Verdict verdict =
      adapt::transfer<dim>(path, {.targets = {path_of_t.begin() + 2, path_of_t.end()}},
                           adapt::make_strategy<dim>({.max_levels = 2}), {.step = check});
  EXPECT_EQ(verdict.status, certify::RunStatus::budget);
}

}  // namespace tribound::test
