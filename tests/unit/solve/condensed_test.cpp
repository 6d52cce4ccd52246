/// @file condensed_test.cpp
/// Newton's method on the contact boundary takes the same steps as with all unknowns.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::test
{

namespace
{

const std::array<problem::ContactLaw, 3> laws{Frictionless(), Tresca(0.02), Coulomb(0.3)};

/// Non-zero prescribed displacements, also on parts of the contact boundary, loads, a gap.
template <int dim>
ProblemData<dim> held_block(const problem::ContactLaw& law)
{
  return {.boundaries = {fixed<dim>("left", 0, formula("0.01*y")),
                         loaded<dim>("top", 0, formula("-0.1*(1+x)"), 0.02), loaded<dim>("right", 0.04, 0.06),
                         obstacle<dim>("bottom", law, formula("0.002*x"))}};
}

/// Only contact holds the block against moving downwards; when it slides, nothing else holds it.
ProblemData<2> resting_block(const problem::ContactLaw& law)
{
  return {.boundaries = {fixed<2>("left", 0, std::nullopt), loaded<2>("top", 0, -0.1),
                         loaded<2>("right", 0.001, 0), obstacle<2>("bottom", law)}};
}

template <int dim>
solve::NewtonResult<dim> solved_by(algebra::LinearMethod method, DiscreteProblem<dim>& c,
                                   std::span<const double> start, double delta)
{
  c.method.solver.method = method;
  return c.solve_from(start, delta,
                      [&](const solve::NewtonIterate<dim>& iterate)
                      {
                        const std::vector<Point<dim>> here = c.form.traction(iterate.contact_u, delta);
                        const std::vector<Point<dim>> everywhere = c.form.traction(iterate.u(), delta);
                        for (std::size_t i = 0; i < here.size(); ++i)
                          EXPECT_LE((here[i] - everywhere[i]).norm(), 1e-12);
                        return false;
                      });
}

template <int dim>
void expect_same_steps(DiscreteProblem<dim>& c, std::span<const double> start = {}, double delta = 0)
{
  const solve::NewtonResult<dim> whole = solved_by<dim>(algebra::LinearMethod::direct, c, start, delta);
  const solve::NewtonResult<dim> condensed =
      solved_by<dim>(algebra::LinearMethod::condensed, c, start, delta);
  ASSERT_EQ(whole.status, solve::NewtonStatus::converged) << whole.message;
  ASSERT_EQ(condensed.status, solve::NewtonStatus::converged) << condensed.message;
  ASSERT_EQ(condensed.steps.size(), whole.steps.size());
  for (std::size_t k = 0; k < whole.steps.size(); ++k)
  {
    EXPECT_EQ(condensed.steps[k].method, algebra::LinearMethod::condensed);
    EXPECT_EQ(condensed.steps[k].damping, whole.steps[k].damping) << "step " << k;
    EXPECT_NEAR(condensed.steps[k].residual, whole.steps[k].residual, 1e-9) << "step " << k;
  }
  EXPECT_LE(distance(condensed.u, whole.u), 1e-9 * norm(whole.u));
  double t_distance = 0;
  for (std::size_t i = 0; i < whole.traction.size(); ++i)
    t_distance = std::max(t_distance, (condensed.traction[i] - whole.traction[i]).norm());
  EXPECT_LE(t_distance, 1e-9);
}

TEST(Condensed, TakesTheSameSteps)
{
  for (const problem::ContactLaw& law : laws)
    for (int p = 1; p <= 4; ++p)
    {
      SCOPED_TRACE(words(law) + ", degree " + std::to_string(p));
      DiscreteProblem<2> c(renumbered(block<2>({8, 4}, {4, 2, 2}), 1), held_block<2>(law), {.degree = p});
      expect_same_steps<2>(c);
      if (p > 2) continue;
      DiscreteProblem<3> in_3d(renumbered(block<3>({8, 4}, {4, 2, 2}), 1), held_block<3>(law), {.degree = p});
      expect_same_steps<3>(in_3d);
    }
}

TEST(Condensed, TakesTheSameStepsFromAStartAndRegularised)
{
  for (const problem::ContactLaw& law : laws)
  {
    SCOPED_TRACE(words(law));
    DiscreteProblem<2> c(renumbered(block<2>({8, 4}), 1), held_block<2>(law), {.degree = 2});
    std::vector<double> start = random_free_vector(c.form.constraints(), 0.01, 3);
    expect_same_steps<2>(c, start);
    expect_same_steps<2>(c, {}, 1e-3);
  }
}

TEST(Condensed, TakesTheSameStepsWhereContactAloneHoldsTheBody)
{
  for (const problem::ContactLaw& law : laws)
  {
    SCOPED_TRACE(words(law));
    DiscreteProblem<2> c(renumbered(block<2>({8, 4}), 1), resting_block(law), {.degree = 2});
    expect_same_steps<2>(c);
  }
}

TEST(Condensed, TakesTheSameStepsWithTwoMaterials)
{
  mesh::MeshData<2> data = block<2>({8, 4});
  data.region_names = {"soft", "stiff"};
  for (std::size_t k = 0; k < data.cells.size(); ++k) data.regions[k] = static_cast<int>(k % 2);
  ProblemData<2> problem = held_block<2>(Coulomb(0.3));
  problem.regions = {{.name = "stiff", .material = lame(1e4, 0.45), .body_force = {0.0, -0.02}}};
  DiscreteProblem<2> c(renumbered(data, 1), problem, {.degree = 2});
  expect_same_steps<2>(c);
}

TEST(Condensed, SharesItsFactors)
{
  DiscreteProblem<2> c(block<2>({8, 4}), held_block<2>(Tresca(0.02)), {.degree = 2});
  const solve::NewtonResult<2> first = c.solve();
  ASSERT_EQ(first.steps.front().method, algebra::LinearMethod::condensed);
  EXPECT_TRUE(first.steps.front().factorised);
  const solve::NewtonResult<2> again =
      solve::solve<2>(c.form, {}, c.method.newton, c.method.solver, {}, 0, first.equilibrium);
  EXPECT_FALSE(again.steps.front().factorised);
  EXPECT_EQ(again.u, first.u);
}

/// A strip with contact along both sides keeps most unknowns: more than 12 n^{1/2}.
TEST(Condensed, IsForShortContactBoundaries)
{
  const auto chosen = [](const mesh::MeshData<2>& data, const std::string& contact, bool from_scratch)
  {
    const DiscreteProblem<2> c(data, {.boundaries = {clamped<2>("left"), obstacle<2>(contact)}},
                               {.degree = 1});
    return solve::choose_method(c.form, {}, from_scratch);
  };
  EXPECT_EQ(chosen(block<2>({16, 8}), "bottom", true), algebra::LinearMethod::condensed);
  EXPECT_EQ(chosen(block<2>({16, 8}), "bottom", false), algebra::LinearMethod::condensed);
  EXPECT_EQ(chosen(block<2>({400, 4}), "bottom", true), algebra::LinearMethod::direct);
  EXPECT_EQ(chosen(block<2>({40, 4}), "bottom", true), algebra::LinearMethod::condensed);
  EXPECT_EQ(chosen(block<2>({40, 4}), "bottom", false), algebra::LinearMethod::direct);
}

}  // namespace

}  // namespace tribound::test
