/// @file persistent_test.cpp
/// The starts of Newton's method.

#include "tribound/adapt/persistent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// A block held on the left, pressed on a floor below which its corner hangs, and pulled along.
template <int dim>
ProblemData<dim> pulled_block(const problem::ContactLaw& law)
{
  return {.boundaries = {clamped<dim>("left"), loaded<dim>("top", 0.01, -0.1, 0.02),
                         obstacle<dim>("bottom", law, formula("0.002*x"))}};
}

template <int dim>
struct Found
{
  solve::NewtonResult<dim> result;
  std::vector<int> degrees_before;    ///< of the steps that led to the start
  std::vector<double> gamma0_before;  ///< likewise
  std::vector<int> degrees;           ///< of the steps from it
};

template <int dim>
Found<dim> find(const DiscreteProblem<dim>& c, const adapt::Method& method,
                const std::vector<double>& start = {})
{
  Found<dim> found;
  const solve::NewtonObserver<dim> observe = [&](const solve::NewtonIterate<dim>& iterate)
  {
    found.degrees.push_back(iterate.step.degree);
    return false;
  };
  found.result = adapt::solve_persistently<dim>(c.form, start, method, observe, 0,
                                                [&](const solve::NewtonStep& step)
                                                {
                                                  found.degrees_before.push_back(step.degree);
                                                  found.gamma0_before.push_back(step.gamma0);
                                                });
  return found;
}

/// The same block pulled up, so that most of it leaves the floor.
ProblemData<3> lifted_block(const problem::ContactLaw& law)
{
  return {.boundaries = {clamped<3>("left"), loaded<3>("top", 0, -0.1), loaded<3>("right", 0.04, 0.06, 0.02),
                         obstacle<3>("bottom", law)}};
}

/// Starts with gamma of a mesh with one facet on the contact boundary, here 18 across. Factors of 3 lead to
/// the given gamma and, in fewer steps, to the same solution.
TEST(SoftStart, LeadsToTheSameSolutionInFewerSteps)
{
  const mesh::MeshData<3> mesh = block<3>({18, 9, 9});
  for (const problem::ContactLaw& law :
       std::vector<problem::ContactLaw>{Frictionless(), Tresca(0.03), Coulomb(0.3)})
  {
    const DiscreteProblem<3> c(mesh, lifted_block(law));
    const solve::NewtonResult<3> from_scratch = c.solve();
    const Found<3> found = find(c, c.method);
    ASSERT_EQ(found.result.status, solve::NewtonStatus::converged) << found.result.message;
    EXPECT_LE(norm(sum(found.result.u, -1, from_scratch.u)), 1e-8 * norm(from_scratch.u));
    EXPECT_LT(found.gamma0_before.size() + found.degrees.size(), from_scratch.steps.size());

    ASSERT_FALSE(found.gamma0_before.empty());
    const double gamma0 = c.form.gamma0();
    EXPECT_NEAR(found.gamma0_before.front(), gamma0 / 27, 1e-12 * gamma0);
    EXPECT_NEAR(found.gamma0_before.back(), gamma0 / 3, 1e-12 * gamma0);
    EXPECT_TRUE(std::ranges::is_sorted(found.gamma0_before));
  }
}

TEST(SoftStart, EndsWhereNearlyAllIsClosedAndSticking)
{
  const DiscreteProblem<3> c(block<3>({18, 9, 9}), pulled_block<3>(Coulomb(0.3)));
  const Found<3> found = find(c, c.method);
  ASSERT_EQ(found.result.status, solve::NewtonStatus::converged) << found.result.message;
  EXPECT_EQ(found.gamma0_before.size(), 1U);
  const std::vector<double> expected = c.solve().u;
  EXPECT_LE(norm(sum(found.result.u, -1, expected)), 1e-8 * norm(expected));
}

/// The start for degree 2 is the solution with degree 1, which has such a start itself.
TEST(SoftStart, ComesFirstForHigherDegrees)
{
  const adapt::Method method{.degree = 2};
  const DiscreteProblem<3> c(block<3>({16, 8, 8}), lifted_block(Tresca(0.03)), method);
  const Found<3> found = find(c, method);
  ASSERT_EQ(found.result.status, solve::NewtonStatus::converged) << found.result.message;
  for (const int degree : found.degrees_before) EXPECT_EQ(degree, 1);
  EXPECT_LT(found.gamma0_before.front(), found.gamma0_before.back());
}

TEST(LowerDegreeStart, LeadsToTheSameSolution)
{
  for (const problem::ContactLaw& law :
       std::vector<problem::ContactLaw>{Frictionless(), Tresca(0.02), Coulomb(0.3)})
    for (int p = 2; p <= 4; ++p)
    {
      SCOPED_TRACE(p);
      const adapt::Method method{.degree = p};
      const DiscreteProblem<3> c(block<3>({6, 3, 3}), pulled_block<3>(law), method);
      const solve::NewtonResult<3> from_scratch = c.solve();
      ASSERT_EQ(from_scratch.status, solve::NewtonStatus::converged) << from_scratch.message;

      const Found<3> found = find(c, method);
      ASSERT_EQ(found.result.status, solve::NewtonStatus::converged) << found.result.message;
      ASSERT_FALSE(found.degrees_before.empty());
      EXPECT_EQ(found.degrees_before.front(), 1);
      EXPECT_EQ(found.degrees_before.back(), (p + 1) / 2);
      for (const int degree : found.degrees_before) EXPECT_LT(degree, p);
      for (const int degree : found.degrees) EXPECT_EQ(degree, p);
      EXPECT_LE(norm(sum(found.result.u, -1, from_scratch.u)), 1e-8 * norm(from_scratch.u));
    }
}

TEST(LowerDegreeStart, OnlyWhereItPays)
{
  const ProblemData<3> data = pulled_block<3>(Tresca(0.02));
  const mesh::MeshData<3> mesh = block<3>({4, 2, 2});
  const DiscreteProblem<3> linear(mesh, data, {.degree = 1});
  EXPECT_TRUE(find(linear, {.degree = 1}).degrees_before.empty());

  const DiscreteProblem<3> quadratic(mesh, data, {.degree = 2});
  const Found<3> first = find(quadratic, {.degree = 2});
  EXPECT_FALSE(first.degrees_before.empty());
  EXPECT_TRUE(find(quadratic, {.degree = 2}, first.result.u).degrees_before.empty());
  EXPECT_TRUE(find(quadratic, {.degree = 2, .newton = {.damping = false}}).degrees_before.empty());
  EXPECT_TRUE(find(quadratic, {.degree = 2, .regularisation = adapt::RegularisationOptions{}})
                  .degrees_before.empty());

  const DiscreteProblem<2> plane(block<2>({8, 4}), pulled_block<2>(Tresca(0.02)), {.degree = 2});
  EXPECT_TRUE(find(plane, {.degree = 2}).degrees_before.empty());
}

}  // namespace

}  // namespace tribound::test
