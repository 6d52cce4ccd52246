#pragma once

/// @file same_on_ranks.h
/// The adaptive, certified loop by all ranks together against the same loop by each rank alone.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/problem_data.h"
#include "tribound/adapt/loop.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/io/record/level_record.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{

/// What must agree of a level.
struct Summary
{
  std::int64_t cells;
  std::int64_t dofs;
  int steps;
  std::vector<double> numbers;
};

template <int dim>
[[nodiscard]] Summary summary(const adapt::LevelView<dim>& view)
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
  const std::vector<bool> slides(form.problem().boundaries().size(), false);
  const io::LevelRecord record = io::level_record<dim>(view, certify::centroid(mesh), slides);
  for (const certify::BalanceRow& row : record.balance->rows)
    for (const std::vector<double>& of_row : {row.force, row.moment})
      result.numbers.insert(result.numbers.end(), of_row.begin(), of_row.end());
  result.numbers.push_back(record.figures.max_displacement);
  for (const io::BodyFigures& body : record.figures.bodies)
    result.numbers.insert(result.numbers.end(), {static_cast<double>(body.cells), body.energy, body.bound});
  for (const io::Resultants& contact : record.figures.boundary_contact)
    if (const auto& pair = contact.pair)
      result.numbers.insert(result.numbers.end(),
                            {static_cast<double>(pair->segments), pair->covered, pair->covered_share,
                             pair->covered_master, pair->smallest_gap, pair->largest_gap});
  EXPECT_LT(view.level.identities.largest(), 1e-9);
  return result;
}

template <int dim>
[[nodiscard]] std::vector<Summary> run(mesh::Mesh<dim> mesh, const ProblemData<dim>& data,
                                       const adapt::Method& method, const adapt::AdaptOptions& options,
                                       std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr)
{
  const problem::Problem<dim> problem = data.on(mesh);
  auto first = std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, method);
  adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(options);
  std::vector<Summary> levels;
  strategy.observer.level = [&](const adapt::LevelView<dim>& view) { levels.push_back(summary(view)); };
  const std::weak_ptr<const mesh::Mesh<dim>> kept = whole;
  adapt::Levels<dim> loop(problem, method, options.tolerance, std::move(first), nullptr, std::move(whole));
  EXPECT_TRUE(kept.expired());  // no rank keeps the whole mesh
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
  mesh::Mesh<dim> part = mesh::share_out<dim>(ranks, whole.get());
  const std::vector<Summary> shared = run<dim>(std::move(part), data, method, options, std::move(whole));
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
      EXPECT_NEAR(shared[level].numbers[i], alone[level].numbers[i], 1e-10 * scale) << "number " << i;
  }
}

}  // namespace tribound::test
