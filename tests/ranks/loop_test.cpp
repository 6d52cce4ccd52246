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
#include "tribound/io/record/level_record.h"
#include "tribound/mesh/geometry.h"
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
  const io::LevelRecord record = io::level_record<dim>(view, certify::centroid(mesh));
  for (const certify::BalanceRow& row : record.balance->rows)
    result.numbers.insert(result.numbers.end(), row.force.begin(), row.force.end());
  result.numbers.push_back(record.figures.max_displacement);
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

enum class Compare
{
  all,
  solutions  ///< not how Newton's method got there
};

/// The loop by all ranks and by each alone.
template <int dim>
void expect_same(const mesh::MeshData<dim>& mesh, const ProblemData<dim>& data, const adapt::Method& method,
                 adapt::AdaptOptions options, Compare compare = Compare::all)
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
    if (compare == Compare::all)
    {
      EXPECT_EQ(shared[level].steps, alone[level].steps);
    }
    ASSERT_EQ(shared[level].numbers.size(), alone[level].numbers.size());
    const double scale = alone[level].numbers[2];  // ||sigma(u)||
    for (std::size_t i = 0; i < alone[level].numbers.size(); ++i)
      EXPECT_NEAR(shared[level].numbers[i], alone[level].numbers[i], 1e-9 * scale) << "number " << i;
  }
}

TEST(Loop, OfEveryDegreeIn2D)
{
  for (const int p : {1, 2, 3, 4})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    expect_same<2>(block<2>({8, 4}), pressed_block<2>(), {.degree = p}, {.max_levels = 4});
  }
}

/// Loads and gap are no polynomials, so that osc, neu and C_F matter; two materials, a bent boundary.
ProblemData<2> rough_data()
{
  ProblemData<2> data = pressed_block<2>(Coulomb(0.3));
  data.body_force[0] = formula("0.1*exp(-20*((x - 1)^2 + (y - 0.5)^2))");
  data.boundaries[1] = loaded<2>("top", 0, formula("-0.1*abs(sin(5*x))"));
  data.boundaries.back() = obstacle<2>("bottom", Coulomb(0.3), formula("0.01*abs(x - 0.7)"));
  return data;
}

TEST(Loop, OnMoreRanksThanCells)
{
  expect_same<2>(block<2>({1, 1}), pressed_block<2>(), {.degree = 2}, {.max_levels = 3});
}

TEST(Loop, WithFormulasAndOtherChoices)
{
  const mesh::MeshData<2> mesh = distorted(block<2>({8, 4}), 7);
  adapt::AdaptOptions options{.max_levels = 3};
  expect_same<2>(mesh, rough_data(), {.degree = 2}, options);
  options.marking = {.strategy = adapt::Marking::maximum, .theta = 0.5, .separate_contact = true};
  expect_same<2>(mesh, rough_data(),
                 {.degree = 1, .stopping = {.criterion = adapt::Stopping::adaptive_local}}, options);
  options.marking.strategy = adapt::Marking::uniform;
  expect_same<2>(mesh, rough_data(), {.degree = 3, .stopping = {.criterion = adapt::Stopping::tolerance}},
                 {.marking = {.strategy = adapt::Marking::uniform}, .max_levels = 1});
  expect_same<2>(mesh, rough_data(), {.degree = 2, .regularisation = adapt::RegularisationOptions()},
                 {.max_levels = 2});
}

TEST(Loop, In3D)
{
  for (const int p : {1, 2})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    ProblemData<3> data = pressed_block<3>(Coulomb(0.4));
    data.body_force[1] = formula("-0.05*sin(2*x)");
    expect_same<3>(block<3>({4, 2, 2}), data, {.degree = p}, {.max_levels = 3 - p});
  }
}

/// Multigrid is another one on another number of ranks: what agrees is what Newton's method converges to.
TEST(Loop, WithMultigrid)
{
  for (const int p : {1, 2})
  {
    SCOPED_TRACE("p = " + std::to_string(p));
    const adapt::Method method{.degree = p,
                               .newton = {.tolerance = 1e-11},
                               .stopping = {.criterion = adapt::Stopping::last_bounded},
                               .solver = {.method = algebra::LinearMethod::iterative}};
    expect_same<3>(block<3>({8, 4, 4}), pressed_block<3>(), method, {.max_levels = 1}, Compare::solutions);
    expect_same<2>(block<2>({16, 8}), pressed_block<2>(), method, {.max_levels = 1}, Compare::solutions);
  }
}

/// What is wrong on one rank alone is seen at facets between ranks, too.
TEST(Identities, SeeFacetsBetweenRanks)
{
  const Ranks ranks = Ranks::world();
  const mesh::MeshData<2> data = block<2>({8, 4});
  auto whole = ranks.is_first() ? std::make_shared<const mesh::Mesh<2>>(data) : nullptr;
  mesh::Mesh<2> mesh = mesh::share_out<2>(ranks, std::move(whole));
  const adapt::Method method{.degree = 2};
  const problem::Problem<2> problem = pressed_block<2>().on(mesh);
  const adapt::Discretisation<2> discrete(std::move(mesh), problem, method);
  adapt::CertifiedLevel<2> level = adapt::solve_and_certify<2>(discrete.form, {}, method);
  const auto defects = [&]
  { return certify::check_identities<2>(discrete.form, level.traction, level.stress); };
  EXPECT_LT(defects().largest(2), 1e-10);
  // A constant stress: no jump inside of a part.
  if (ranks.is_first())
    for (std::size_t c = 0; c < level.estimate.cells.size(); ++c)
    {
      const auto index = static_cast<Index>(c);
      const double root = std::sqrt(mesh::cell_map(discrete.mesh, index).det);
      for (const int entry : {0, 3})
        level.stress.dis[c * level.stress.block_size() + entry * level.stress.n] += 0.01 * root;
    }
  EXPECT_GT(defects().jump, 1e-3);
  EXPECT_LT(defects().divergence, 1e-10);
}

}  // namespace
}  // namespace tribound::test
