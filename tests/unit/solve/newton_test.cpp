/// @file newton_test.cpp
/// The generalised Newton method on small cases of every friction law.

#include "tribound/solve/newton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/base/error.h"

namespace tribound::test::newton_cases
{

namespace
{

using ::testing::HasSubstr;

const std::vector<problem::ContactLaw> laws{Frictionless(), Tresca(0.02), Coulomb(0.3)};

/// A block clamped on the left, pressed on a floor that it meets in part, and pulled at its right side.
template <int dim>
ProblemData<dim> lifted_block(const problem::ContactLaw& law)
{
  return {.boundaries = {fixed<dim>("left", 0, formula("0.01*y")), loaded<dim>("top", 0, -0.1, 0.02),
                         loaded<dim>("right", 0.04, 0.06), obstacle<dim>("bottom", law, formula("0.002*x"))}};
}

template <int dim>
mesh::MeshData<dim> renumbered_block()
{
  return renumbered(block<dim>({8, 4}, {4, 2, 2}), 1);
}

/// Size of a(u, v) - (t, v)_C - L(v) over free v, relative to L.
template <int dim>
double imbalance(const DiscreteProblem<dim>& c, std::span<const double> u, std::span<const Point<dim>> t)
{
  std::vector<double> forces(c.form.load().begin(), c.form.load().end());
  c.form.add_contact_load(t, forces);
  const std::vector<double> rest = sum(contact::apply_stiffness<dim>(c.problem, c.space, u), -1, forces);
  return norm(free_part(c.form.constraints(), rest)) / norm(free_part(c.form.constraints(), c.form.load()));
}

template <int dim>
void expect_prescribed_displacements(const DiscreteProblem<dim>& c, std::span<const double> u)
{
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_TRUE(!c.form.constraints().fixed[i] || u[i] == c.form.constraints().values[i]);
}

template <int dim>
void expect_solved(int p, const problem::ContactLaw& law)
{
  const DiscreteProblem<dim> c(renumbered_block<dim>(), lifted_block<dim>(law),
                               {.degree = p, .newton = {.tolerance = 1e-11}});
  const solve::NewtonResult<dim> result = c.solve();
  ASSERT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_TRUE(result.message.empty());
  EXPECT_LE(result.steps.size(), 20u);
  EXPECT_LE(result.steps.back().residual, 1e-11);
  EXPECT_LE(imbalance<dim>(c, result.u, c.form.traction(result.u)), 1e-10);
  expect_prescribed_displacements<dim>(c, result.u);
  for (std::size_t k = 0; k < result.steps.size(); ++k)
    EXPECT_EQ(result.steps[k].step, static_cast<int>(k) + 1);
}

/// The tight solve at the end is skipped when only a start for another solve is needed.
TEST(Newton, LeavesTheTractionLooseWhereOnlyAStartIsWanted)
{
  const algebra::SolverOptions multigrid{.method = algebra::LinearMethod::iterative};
  const auto solve = [&](bool balanced)
  {
    const DiscreteProblem<3> c(
        renumbered_block<3>(), lifted_block<3>(Tresca(0.02)),
        {.degree = 1, .newton = {.tolerance = 0.02, .balanced = balanced}, .solver = multigrid});
    const solve::NewtonResult<3> result = c.solve();
    EXPECT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
    EXPECT_LE(imbalance<3>(c, result.u, c.form.traction(result.u)), 0.05);
    return std::pair(imbalance<3>(c, result.u, result.traction), result.steps.back().linear_iterations);
  };
  const auto [tight, tight_iterations] = solve(true);
  const auto [loose, loose_iterations] = solve(false);
  EXPECT_LE(tight, 1e-9);
  EXPECT_GT(loose, 1e-6);
  EXPECT_LT(loose_iterations, tight_iterations);
}

TEST(Newton, SolvesEveryLaw)
{
  for (const problem::ContactLaw& law : laws)
    for (int p = 1; p <= 4; ++p)
    {
      SCOPED_TRACE(words(law) + ", degree " + std::to_string(p));
      expect_solved<2>(p, law);
      if (p <= 2) expect_solved<3>(p, law);
    }
}

/// a(u^k, v) - (t^k, v)_C = L(v) at every iterate, converged or not, whatever the damping. Returns the
/// smallest damping factor that occurred.
template <int dim>
double expect_balance_at_every_iterate(const problem::ContactLaw& law, const mesh::MeshData<dim>& mesh,
                                       const adapt::Method& method)
{
  DiscreteProblem<dim> c(mesh, lifted_block<dim>(law), method);
  double smallest = 1;
  for (int k = 1; k <= 9; ++k)
  {
    c.method.newton.max_steps = k;
    const solve::NewtonResult<dim> result = c.solve();
    EXPECT_LE(imbalance<dim>(c, result.u, result.traction), 1e-10) << "iterate " << k;
    smallest = std::min(smallest, result.steps.back().damping);
    if (result.status != solve::NewtonStatus::too_many_steps) break;
    EXPECT_EQ(result.steps.size(), static_cast<std::size_t>(k));
    EXPECT_GT(imbalance<dim>(c, result.u, c.form.traction(result.u)), 1e-10) << "iterate " << k;
  }
  return smallest;
}

TEST(Newton, RunningTractionBalancesEveryIterate)
{
  for (const problem::ContactLaw& law : laws)
    for (const bool damping : {true, false})
    {
      SCOPED_TRACE(words(law));
      expect_balance_at_every_iterate<2>(law, renumbered_block<2>(),
                                         {.degree = 2, .newton = {.damping = damping}});
      expect_balance_at_every_iterate<3>(law, renumbered_block<3>(),
                                         {.degree = 1, .newton = {.damping = damping}});
    }
}

/// A larger gamma_0 makes full steps overshoot.
TEST(Newton, RunningTractionBalancesDampedIterates)
{
  double smallest = 1;
  for (const problem::ContactLaw& law : laws)
    smallest = std::min(smallest, expect_balance_at_every_iterate<2>(law, renumbered(block<2>({16, 8}), 1),
                                                                     {.degree = 1, .gamma0 = 1000}));
  EXPECT_LT(smallest, 1);
}

TEST(Newton, EveryLinearSolverGivesTheSameSolution)
{
  for (const problem::ContactLaw& law : laws)
  {
    DiscreteProblem<3> c(renumbered_block<3>(), lifted_block<3>(law),
                         {.degree = 2, .newton = {.tolerance = 1e-12}});
    c.method.solver.package = algebra::DirectPackage::mumps;
    const solve::NewtonResult<3> mumps = c.solve();
    c.method.solver.package = algebra::DirectPackage::umfpack;
    const solve::NewtonResult<3> umfpack = c.solve();
    c.method.solver.method = algebra::LinearMethod::iterative;
    const solve::NewtonResult<3> multigrid = c.solve();
    c.method.solver.method = algebra::LinearMethod::condensed;
    const solve::NewtonResult<3> condensed = c.solve();
    for (const solve::NewtonResult<3>* result : {&mumps, &umfpack, &multigrid, &condensed})
    {
      ASSERT_EQ(result->status, solve::NewtonStatus::converged) << words(law) << ": " << result->message;
      EXPECT_LE(distance(result->u, mumps.u), 1e-9 * norm(mumps.u)) << words(law);
      expect_prescribed_displacements<3>(c, result->u);
    }
  }
}

/// Newton restarted at every iterate, with its own factors in each step, must take the same path as one that
/// keeps factors.
TEST(Newton, KeptFactorsDoNotChangeTheIterates)
{
  for (const problem::ContactLaw& law : laws)
  {
    DiscreteProblem<2> c(
        renumbered_block<2>(), lifted_block<2>(law),
        {.degree = 2, .newton = {.damping = false}, .solver = {.method = algebra::LinearMethod::direct}});
    const solve::NewtonResult<2> together = c.solve();
    ASSERT_EQ(together.status, solve::NewtonStatus::converged);
    EXPECT_FALSE(std::ranges::all_of(together.steps, &solve::NewtonStep::factorised)) << words(law);
    c.method.newton.max_steps = 1;
    std::vector<double> u;
    for (std::size_t k = 0; k < together.steps.size(); ++k)
    {
      const solve::NewtonResult<2> one = c.solve_from(u);
      EXPECT_TRUE(one.steps.back().factorised);
      u = one.u;
    }
    EXPECT_LE(distance(u, together.u), 1e-9 * norm(u)) << words(law);
  }
}

TEST(Newton, StartsFromAGivenVector)
{
  const DiscreteProblem<2> c(renumbered_block<2>(), lifted_block<2>(laws[2]), {.degree = 2});
  const solve::NewtonResult<2> from_scratch = c.solve();
  const solve::NewtonResult<2> restarted = c.solve_from(from_scratch.u);
  ASSERT_EQ(restarted.status, solve::NewtonStatus::converged);
  EXPECT_EQ(restarted.steps.size(), 1u);  // one step at least
  EXPECT_LE(distance(restarted.u, from_scratch.u), 1e-8 * norm(from_scratch.u));
  EXPECT_LE(imbalance<2>(c, restarted.u, restarted.traction), 1e-10);
}

TEST(Newton, ReportsEachStep)
{
  const DiscreteProblem<2> c(renumbered_block<2>(), lifted_block<2>(laws[1]));
  std::vector<double> residuals;
  const solve::NewtonResult<2> result = c.solve(0,
                                                [&](const solve::NewtonIterate<2>& iterate)
                                                {
                                                  residuals.push_back(iterate.step.residual);
                                                  return false;
                                                });
  ASSERT_EQ(residuals.size(), result.steps.size());
  for (std::size_t k = 0; k < residuals.size(); ++k) EXPECT_EQ(residuals[k], result.steps[k].residual);
}

TEST(Newton, SaysThatTheStepsDidNotSuffice)
{
  const DiscreteProblem<2> c(renumbered_block<2>(), lifted_block<2>(laws[2]),
                             {.degree = 1, .newton = {.max_steps = 2}});
  const solve::NewtonResult<2> result = c.solve();
  EXPECT_EQ(result.status, solve::NewtonStatus::too_many_steps);
  EXPECT_EQ(result.steps.size(), 2u);
  EXPECT_THAT(result.message, HasSubstr("step 2 was the last"));
}

TEST(Newton, ASingularMatrixIsAnError)
{
  const DiscreteProblem<2> c(renumbered_block<2>(),
                             {.boundaries = {loaded<2>("top", 1, -1), obstacle<2>("bottom")}});
  EXPECT_THROW((void)c.solve(), SolveError);
}

TEST(Newton, NoLoadNoDisplacement)
{
  const DiscreteProblem<2> c(renumbered_block<2>(),
                             {.boundaries = {clamped<2>("left"), obstacle<2>("bottom", Coulomb(0.3))}},
                             {.degree = 2});
  const solve::NewtonResult<2> result = c.solve();
  EXPECT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_EQ(norm(result.u), 0);
}

/// The corner points of the contact facet are fixed: no free degree of freedom feels the contact traction,
/// and the first step, closed and sticking, leaves no residual. Still, the contact is open.
TEST(Newton, ConvergedMeansThatTheTractionIsThatOfTheSolution)
{
  mesh::MeshData<2> data{{.region_names = {"body"}, .boundary_names = {"bottom", "sides"}},
                         {{0, 0}, {1, 0}, {0.5, 1}, {0.5, 0.4}},
                         {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                         {0, 0, 0},
                         {{{0, 1}, 0}, {{1, 2}, 1}, {{2, 0}, 1}}};
  const DiscreteProblem<2> c(data, {.boundaries = {fixed<2>("sides", formula("0.01*x"), 0),
                                                   obstacle<2>("bottom", Frictionless(), 0.1)}});
  const solve::NewtonResult<2> result = c.solve();
  ASSERT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_EQ(result.steps.size(), 2u);
  for (const Point<2>& t : result.traction) EXPECT_LE(t.norm(), 1e-12);
}

}  // namespace

}  // namespace tribound::test::newton_cases
