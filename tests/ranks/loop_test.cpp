/// @file loop_test.cpp
/// The adaptive, certified loop on several ranks against the same on one: meshes, Newton steps, bounds.

#include "tribound/adapt/loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

/// What is to agree of a level.
struct Summary
{
  std::int64_t cells;
  std::int64_t dofs;
  int steps;
  std::vector<double> numbers;
};

template <int dim>
Summary summary(const adapt::LevelView<dim>& view)
{
  const contact::NitscheForm<dim>& form = view.discrete.form;
  const mesh::Mesh<dim>& mesh = view.discrete.mesh;
  Summary result{mesh.n_global_cells(),
                 fem::n_free_dofs(form.space(), form.constraints()),
                 static_cast<int>(view.level.steps.size()),
                 {}};
  const certify::Estimate& estimate = view.level.estimate;
  result.numbers = {estimate.total, estimate.total_sharp, view.level.norms.sigma, view.level.norms.energy};
  for (const certify::Component& c : certify::all_components)
    result.numbers.push_back(estimate.global.*c.value);
  const auto resultants = contact::contact_resultants<dim>(form, form.traction(view.level.u));
  result.numbers.insert(result.numbers.end(), {resultants.normal, resultants.tangential});
  const auto balance = certify::balance<dim>(form, view.level.stress, certify::centroid(mesh));
  for (const certify::BalanceRow& row : balance.rows)
    result.numbers.insert(result.numbers.end(), row.force.begin(), row.force.end());
  EXPECT_LT(view.level.identities.largest(form.space().degree()), 1e-9);
  return result;
}

template <int dim>
std::vector<Summary> run(mesh::Mesh<dim> mesh, const ProblemData<dim>& data, const adapt::Method& method,
                         const adapt::AdaptOptions& options)
{
  const problem::Problem<dim> problem = data.on(mesh);
  auto first = std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, method);
  adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(options);
  std::vector<Summary> levels;
  strategy.observer.level = [&](const adapt::LevelView<dim>& view) { levels.push_back(summary(view)); };
  adapt::Levels<dim> loop(problem, method, options.tolerance, std::move(first));
  EXPECT_EQ(adapt::adapt(loop, strategy).status, certify::RunStatus::budget);
  return levels;
}

/// The loop by all ranks and by each alone.
template <int dim>
void expect_same(const mesh::MeshData<dim>& mesh, const ProblemData<dim>& data, const adapt::Method& method,
                 adapt::AdaptOptions options)
{
  options.tolerance = 1e-6;
  const Ranks ranks = Ranks::world();
  const std::vector<Summary> alone = run<dim>(mesh::Mesh<dim>(mesh), data, method, options);
  auto whole = ranks.is_first() ? std::make_shared<const mesh::Mesh<dim>>(mesh) : nullptr;
  const std::vector<Summary> shared =
      run<dim>(mesh::share_out<dim>(ranks, std::move(whole)), data, method, options);
  ASSERT_EQ(alone.size(), shared.size());
  for (std::size_t level = 0; level < alone.size(); ++level)
  {
    SCOPED_TRACE("level " + std::to_string(level));
    EXPECT_EQ(shared[level].cells, alone[level].cells);
    EXPECT_EQ(shared[level].dofs, alone[level].dofs);
    EXPECT_EQ(shared[level].steps, alone[level].steps);
    ASSERT_EQ(shared[level].numbers.size(), alone[level].numbers.size());
    const double scale = alone[level].numbers[2];  // ||sigma(u)||
    for (std::size_t i = 0; i < alone[level].numbers.size(); ++i)
      EXPECT_NEAR(shared[level].numbers[i], alone[level].numbers[i], 1e-9 * scale) << "number " << i;
  }
}

TEST(Loop, Tresca2D)
{
  for (const int p : {1, 2, 3, 4})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    expect_same<2>(block<2>({8, 4}), pressed_block<2>(), {.degree = p}, {.max_levels = 4});
  }
}

TEST(Loop, Coulomb3D)
{
  for (const int p : {1, 2})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    ProblemData<3> data = pressed_block<3>(Coulomb(0.4));
    data.body_force[1] = formula("-0.05*sin(2*x)");
    expect_same<3>(block<3>({4, 2, 2}), data, {.degree = p}, {.max_levels = 3 - p});
  }
}

}  // namespace
}  // namespace tribound::test
