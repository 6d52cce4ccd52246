/// @file path_test.cpp
/// Load paths with history-dependent interfaces, on several ranks against one.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/bonded_path.h"
#include "tribound/adapt/transfer.h"
#include "tribound/io/record/hydraulic_figures.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

/// Energy, bounds, forces and the integrals of damage, slip and dissipation at each step.
template <int dim>
std::vector<double> follow(mesh::Mesh<dim> mesh, const ProblemData<dim>& data, int degree,
                           std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr)
{
  const problem::Problem<dim> problem = data.on(mesh);
  adapt::Method method{.degree = degree, .newton = {.tolerance = 1e-11}};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  method.solver.method = algebra::LinearMethod::direct;
  adapt::LoadPath<dim> path(problem, method, {}, std::move(mesh), nullptr, std::move(whole));
  path.ask_for({.levels = adapt::EnergyLevels::every});
  std::vector<double> numbers;
  const auto add = [&](const adapt::LoadStep<dim>& step)
  {
    const contact::NitscheForm<dim>& form = step.at->discrete.form;
    const InterfaceIntegrals sums = integrals<dim>(step);
    const auto contact = contact::contact_resultants<dim>(form, step.level.traction);
    numbers.insert(numbers.end(),
                   {sums.damage, sums.slipped, sums.dissipated, sums.stored, step.level.norms.energy,
                    step.level.norms.sigma, step.level.estimate.total_sharp, contact.normal,
                    contact.tangential, step.level.energy.value().bound});
    for (const contact::CrackTip& tip : step.crack_tips)
      numbers.insert(numbers.end(), {tip.distance, tip.farthest, static_cast<double>(step.passes)});
    const auto boundaries = form.problem().boundaries();
    for (std::size_t tag = 0; tag < boundaries.size(); ++tag)
      if (const auto figures = io::hydraulic_figures<dim>(step, static_cast<int>(tag)))
        numbers.insert(numbers.end(), {figures->effective_normal, figures->uplift, figures->cmod.value(),
                                       figures->csd.value(), figures->overturning.value_or(0)});
    EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified);
    const problem::Contact& first = *form.problem().contacts().front();
    const bool is_bounded = !cone(first.law).is_bonded && !first.water;
    EXPECT_EQ(step.level.energy.value().reason.empty(), is_bounded) << step.level.energy->reason;
  };
  for (const double t : path_of_t) EXPECT_EQ(path.advance(t, add), "");
  return numbers;
}

template <int dim>
void expect_same(const problem::ContactLaw& law, int degree, bool pairs, bool water = false)
{
  SCOPED_TRACE(problem::words(law));
  const Ranks ranks = Ranks::world();
  const mesh::MeshData<dim> data = peeled_mesh<dim>(pairs);
  const ProblemData<dim> problem = water ? peeled_under_water<dim>(law, pairs) : peeled<dim>(law, pairs);
  const auto whole = ranks.is_first() ? std::make_shared<const mesh::Mesh<dim>>(data) : nullptr;
  const std::vector<double> alone = follow<dim>(mesh::Mesh<dim>(data), problem, degree);
  const std::vector<double> together =
      follow<dim>(mesh::share_out<dim>(ranks, whole.get()), problem, degree, whole);
  ASSERT_EQ(together.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_NEAR(together[i], alone[i], 1e-9) << i;
}

TEST(LoadPath, IsTheSameOnAllRanks)
{
  for (const problem::ContactLaw& law : bonded_laws())
    for (const bool pairs : {false, true}) expect_same<2>(law, 2, pairs);
  expect_same<3>(bonded_laws()[1], 1, true);
  expect_same<3>(bonded_laws()[3], 1, false);
}

/// t, cells, damage, slip, energy, bound and work at each step of a path whose meshes become finer along it.
template <int dim>
std::vector<double> transferred(mesh::Mesh<dim> mesh, const ProblemData<dim>& data, int degree,
                                std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr)
{
  const problem::Problem<dim> problem = data.on(mesh);
  adapt::Method method{.degree = degree, .newton = {.tolerance = 1e-11}};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  method.solver.method = algebra::LinearMethod::direct;
  adapt::LoadPath<dim> path(problem, method, {.tolerance = 1e-3}, std::move(mesh), nullptr, std::move(whole));
  std::vector<double> numbers;
  const auto add = [&](const adapt::LoadStep<dim>& step)
  {
    const InterfaceIntegrals sums = integrals<dim>(step);
    numbers.insert(numbers.end(), {step.t, static_cast<double>(step.at->discrete.mesh.n_global_cells()),
                                   sums.damage, sums.slipped, sums.dissipated, sums.stored,
                                   step.level.norms.energy, step.level.estimate.total_sharp, step.work});
  };
  for (const double t : {path_of_t[0], path_of_t[1]}) EXPECT_EQ(path.advance(t, add), "");
  const certify::Verdict verdict =
      adapt::transfer<dim>(path, {.targets = {path_of_t.begin() + 2, path_of_t.end()}},
                           adapt::make_strategy<dim>({.max_levels = 2}), {.step = add});
  EXPECT_TRUE(certify::is_bound(verdict.status)) << verdict.reason;
  return numbers;
}

template <int dim>
void expect_the_same_transfer(const problem::ContactLaw& law, int degree, bool pairs)
{
  SCOPED_TRACE(problem::words(law));
  const Ranks ranks = Ranks::world();
  const mesh::MeshData<dim> data = peeled_mesh<dim>(pairs);
  const ProblemData<dim> problem = peeled<dim>(law, pairs);
  const auto whole = ranks.is_first() ? std::make_shared<const mesh::Mesh<dim>>(data) : nullptr;
  const std::vector<double> alone = transferred<dim>(mesh::Mesh<dim>(data), problem, degree);
  const std::vector<double> together =
      transferred<dim>(mesh::share_out<dim>(ranks, whole.get()), problem, degree, whole);
  ASSERT_EQ(together.size(), alone.size());
  EXPECT_GT(alone.at(9 * (path_of_t.size() - 1) + 1), alone[1]);  // cells
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_NEAR(together[i], alone[i], 1e-9) << i;
}

TEST(LoadPath, HistoryIsCarriedToTheSameMeshesOnAllRanks)
{
  for (const std::size_t i : {1, 3, 5})
    for (const bool pairs : {false, true}) expect_the_same_transfer<2>(bonded_laws()[i], 2, pairs);
  expect_the_same_transfer<3>(bonded_laws()[1], 1, false);
}

/// The tip of a crack, which all ranks find together, and its consequences.
TEST(LoadPath, CracksUnderWaterAreTheSameOnAllRanks)
{
  for (const bool pairs : {false, true}) expect_same<2>(bonded_laws()[1], 2, pairs, true);
  expect_same<3>(bonded_laws()[0], 1, false, true);
  expect_same<3>(bonded_laws()[3], 1, true, true);
}

}  // namespace
}  // namespace tribound::test
