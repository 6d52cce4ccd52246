/// @file nested_solver_test.cpp
/// Adaptive runs solved by multigrid on their sequence of meshes, against factorisations.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/meshes.h"
#include "verification/run_adaptively.h"

namespace tribound::test
{

namespace
{

struct Level
{
  Index cells;
  std::size_t steps;
  double bound;
};

template <int dim>
std::vector<Level> run(algebra::LinearMethod method, const problem::ContactLaw& law, int degree, int max_dofs)
{
  std::vector<Level> levels;
  const adapt::LoopObserver<dim> observer = {
      {},
      [&](const adapt::LevelView<dim>& view)
      {
        const certify::Estimate& eta = view.level.estimate;  // the remainders of solvers differ
        levels.push_back(
            {view.discrete.mesh.n_cells(), view.level.steps.size(), eta.total_sharp - eta.global.alg});
      }};
  const adapt::Method options{.degree = degree,
                              .stopping = {.criterion = adapt::Stopping::tolerance},
                              .solver = {.method = method, .gamma_alg = 0}};
  const certify::Verdict verdict = run_adaptively<dim>(
      block<dim>({4, 2}, {2, 1, 1}), pressed_block<dim>(law), options,
      {.tolerance = 1e-9, .marking = {.theta = 0.5}, .max_levels = 60, .max_dofs = max_dofs}, observer);
  EXPECT_EQ(verdict.status, certify::RunStatus::budget) << verdict.reason;
  return levels;
}

template <int dim>
void expect_same_run(const problem::ContactLaw& law, int degree, int max_dofs)
{
  const std::vector<Level> direct = run<dim>(algebra::LinearMethod::direct, law, degree, max_dofs);
  const std::vector<Level> multigrid = run<dim>(algebra::LinearMethod::iterative, law, degree, max_dofs);
  ASSERT_EQ(multigrid.size(), direct.size());
  ASSERT_GE(direct.size(), 4U);
  for (std::size_t k = 0; k < direct.size(); ++k)
  {
    SCOPED_TRACE(k);
    EXPECT_EQ(multigrid[k].cells, direct[k].cells);
    EXPECT_NEAR(multigrid[k].bound, direct[k].bound, 1e-9 * direct[k].bound);
    EXPECT_LE(multigrid[k].steps, direct[k].steps + 2);  // loose solves may take one or two more
  }
}

TEST(NestedSolver, TakesTheAdaptiveRunThatFactorsTake)
{
  expect_same_run<2>(Tresca(0.03), 1, 4000);
  expect_same_run<2>(Coulomb(0.3), 2, 4000);
  expect_same_run<3>(Tresca(0.03), 1, 3000);
  expect_same_run<3>(Coulomb(0.3), 1, 2000);
}

}  // namespace

}  // namespace tribound::test
