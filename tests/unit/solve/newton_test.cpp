/// @file newton_test.cpp
/// The generalised Newton method on small cases of every friction law.

#include "tribound/solve/newton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/discrete_case.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/base/error.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

const std::vector<std::string> laws{"friction = \"none\"", "friction = \"tresca\", threshold = 0.02",
                                    "friction = \"coulomb\", coefficient = 0.3"};

/// A block clamped on the left, pressed on a floor that it meets in part, pulled at its right side.
template <int dim>
std::string pressed_block(int p, const std::string& law)
{
  const bool flat = dim == 2;
  return "degree = " + std::to_string(p) + "\nmaterial = { E = 1, nu = 0.3 }\n" +
         "boundary.left.displacement = " + (flat ? "[0, \"0.01*y\"]" : "[0, \"0.01*y\", 0]") +
         "\nboundary.top.traction = " + (flat ? "[0, -0.1]" : "[0, -0.1, 0.02]") +
         "\nboundary.right.traction = " + (flat ? "[0.04, 0.06]" : "[0.04, 0.06, 0]") +
         "\nboundary.bottom.contact = { gap = \"0.002*x\", " + law + " }\n";
}

template <int dim>
mesh::MeshData<dim> block()
{
  if constexpr (dim == 2)
    return renumbered(box<2>({0, 0}, {2, 1}, {8, 4}), 1);
  else
    return renumbered(box<3>({0, 0, 0}, {2, 1, 1}, {4, 2, 2}), 1);
}

/// Size of a(u, v) - (t, v)_C - L(v) over free v, relative to L.
template <int dim>
double imbalance(const DiscreteCase<dim>& c, std::span<const double> u, std::span<const Point<dim>> t)
{
  std::vector<double> forces(c.form.load().begin(), c.form.load().end());
  c.form.add_contact_load(t, forces);
  const std::vector<double> rest = sum(contact::apply_stiffness<dim>(c.problem, c.space, u), -1, forces);
  return norm(free_part(c.form.constraints(), rest)) / norm(free_part(c.form.constraints(), c.form.load()));
}

template <int dim>
void expect_solved(int p, const std::string& law)
{
  DiscreteCase<dim> c(pressed_block<dim>(p, law), block<dim>());
  c.config.method.newton.tolerance = 1e-11;
  const solve::NewtonResult<dim> result = c.solve();
  ASSERT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_TRUE(result.message.empty());
  EXPECT_LE(result.steps.size(), 20u);
  EXPECT_LE(result.steps.back().residual, 1e-11);
  EXPECT_LE(imbalance<dim>(c, result.u, c.form.traction(result.u)), 1e-10);
  for (std::size_t i = 0; i < result.u.size(); ++i)
    EXPECT_TRUE(!c.form.constraints().fixed[i] || result.u[i] == c.form.constraints().values[i]);
  for (std::size_t k = 0; k < result.steps.size(); ++k)
    EXPECT_EQ(result.steps[k].step, static_cast<int>(k) + 1);
}

TEST(Newton, SolvesEveryLaw)
{
  for (const std::string& law : laws)
    for (int p = 1; p <= 4; ++p)
    {
      SCOPED_TRACE(law + ", degree " + std::to_string(p));
      expect_solved<2>(p, law);
      if (p <= 2) expect_solved<3>(p, law);
    }
}

/// a(u^k, v) - (t^k, v)_C = L(v) at every iterate, converged or not, whatever the damping. Returns the
/// smallest damping that occurred.
template <int dim>
double expect_balance_at_every_iterate(const std::string& toml, const mesh::MeshData<dim>& mesh, bool damping)
{
  DiscreteCase<dim> c(toml, mesh);
  c.config.method.newton.damping = damping;
  double smallest = 1;
  for (int k = 1; k <= 9; ++k)
  {
    c.config.method.newton.max_steps = k;
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
  for (const std::string& law : laws)
    for (const bool damping : {true, false})
    {
      SCOPED_TRACE(law);
      expect_balance_at_every_iterate<2>(pressed_block<2>(2, law), block<2>(), damping);
      expect_balance_at_every_iterate<3>(pressed_block<3>(1, law), block<3>(), damping);
    }
}

/// A larger gamma_0 makes full steps overshoot.
TEST(Newton, RunningTractionBalancesDampedIterates)
{
  double smallest = 1;
  for (const std::string& law : laws)
    smallest = std::min(
        smallest, expect_balance_at_every_iterate<2>("nitsche.gamma0 = 1000\n" + pressed_block<2>(1, law),
                                                     renumbered(box<2>({0, 0}, {2, 1}, {16, 8}), 1), true));
  EXPECT_LT(smallest, 1);
}

TEST(Newton, EveryLinearSolverGivesTheSameSolution)
{
  for (const std::string& law : laws)
  {
    DiscreteCase<3> c(pressed_block<3>(2, law), block<3>());
    c.config.method.newton.tolerance = 1e-12;
    c.config.method.solver.package = algebra::DirectPackage::mumps;
    const solve::NewtonResult<3> mumps = c.solve();
    c.config.method.solver.package = algebra::DirectPackage::umfpack;
    const solve::NewtonResult<3> umfpack = c.solve();
    c.config.method.solver.method = algebra::LinearMethod::iterative;
    const solve::NewtonResult<3> multigrid = c.solve();
    for (const solve::NewtonResult<3>* result : {&mumps, &umfpack, &multigrid})
    {
      ASSERT_EQ(result->status, solve::NewtonStatus::converged) << law << ": " << result->message;
      EXPECT_LE(distance(result->u, mumps.u), 1e-9 * norm(mumps.u)) << law;
    }
  }
}

/// Each step with factors of its own: Newton restarted at every iterate must go the same way as one that
/// keeps factors.
TEST(Newton, KeptFactorsDoNotChangeTheIterates)
{
  for (const std::string& law : laws)
  {
    DiscreteCase<2> c(pressed_block<2>(2, law), block<2>());
    c.config.method.newton.damping = false;
    const solve::NewtonResult<2> together = c.solve();
    ASSERT_EQ(together.status, solve::NewtonStatus::converged);
    EXPECT_FALSE(std::ranges::all_of(together.steps, &solve::NewtonStep::factorised)) << law;
    c.config.method.newton.max_steps = 1;
    std::vector<double> u;
    for (std::size_t k = 0; k < together.steps.size(); ++k)
    {
      const solve::NewtonResult<2> one =
          tribound::solve::solve<2>(c.form, u, c.config.method.newton, c.config.method.solver);
      EXPECT_TRUE(one.steps.back().factorised);
      u = one.u;
    }
    EXPECT_LE(distance(u, together.u), 1e-9 * norm(u)) << law;
  }
}

TEST(Newton, StartsFromAGivenVector)
{
  DiscreteCase<2> c(pressed_block<2>(2, laws[2]), block<2>());
  const solve::NewtonResult<2> from_scratch = c.solve();
  const solve::NewtonResult<2> restarted =
      tribound::solve::solve<2>(c.form, from_scratch.u, c.config.method.newton, c.config.method.solver);
  ASSERT_EQ(restarted.status, solve::NewtonStatus::converged);
  EXPECT_EQ(restarted.steps.size(), 1u);  // one step at least
  EXPECT_LE(distance(restarted.u, from_scratch.u), 1e-8 * norm(from_scratch.u));
  EXPECT_LE(imbalance<2>(c, restarted.u, restarted.traction), 1e-10);
}

TEST(Newton, ReportsEachStep)
{
  const DiscreteCase<2> c(pressed_block<2>(1, laws[1]), block<2>());
  std::vector<double> residuals;
  const solve::NewtonResult<2> result =
      tribound::solve::solve<2>(c.form, {}, c.config.method.newton, c.config.method.solver,
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
  DiscreteCase<2> c(pressed_block<2>(1, laws[2]), block<2>());
  c.config.method.newton.max_steps = 2;
  const solve::NewtonResult<2> result = c.solve();
  EXPECT_EQ(result.status, solve::NewtonStatus::too_many_steps);
  EXPECT_EQ(result.steps.size(), 2u);
  EXPECT_THAT(result.message, HasSubstr("step 2 was the last"));
}

TEST(Newton, ASingularMatrixIsAnError)
{
  const DiscreteCase<2> c(
      "degree = 1\nmaterial = { E = 1, nu = 0.3 }\nboundary.top.traction = [1, -1]\n"
      "boundary.bottom.contact = { friction = \"none\" }",
      block<2>());
  EXPECT_THROW((void)c.solve(), SolveError);
}

TEST(Newton, NoLoadNoDisplacement)
{
  const DiscreteCase<2> c(
      "degree = 2\nmaterial = { E = 1, nu = 0.3 }\nboundary.left.displacement = [0, 0]\n"
      "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.3 }",
      block<2>());
  const solve::NewtonResult<2> result = c.solve();
  EXPECT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_EQ(norm(result.u), 0);
}

/// The corner points of the contact facet are held: no free degree of freedom feels the contact traction, and
/// the first step, closed and sticking, leaves no residual. The contact is open all the same.
TEST(Newton, ConvergedMeansThatTheTractionIsThatOfTheSolution)
{
  mesh::MeshData<2> data{.vertices = {{0, 0}, {1, 0}, {0.5, 1}, {0.5, 0.4}},
                         .cells = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                         .regions = {0, 0, 0},
                         .facets = {{{0, 1}, 0}, {{1, 2}, 1}, {{2, 0}, 1}},
                         .region_names = {"body"},
                         .boundary_names = {"bottom", "sides"},
                         .source = {}};
  const DiscreteCase<2> c(
      "degree = 1\nmaterial = { E = 1, nu = 0.3 }\nboundary.sides.displacement = [\"0.01*x\", 0]\n"
      "boundary.bottom.contact = { friction = \"none\", gap = 0.1 }",
      data);
  const solve::NewtonResult<2> result = c.solve();
  ASSERT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_EQ(result.steps.size(), 2u);
  for (const Point<2>& t : result.traction) EXPECT_LE(t.norm(), 1e-12);
}

}  // namespace

}  // namespace tribound::test
