#pragma once

/// @file transfer_paths.h
/// Load paths on meshes that become finer along them, and their reports.

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "support/bonded_path.h"
#include "tribound/adapt/transfer.h"
#include "tribound/io/record/load_step_record.h"
#include "tribound/mesh/bisect.h"

namespace tribound::transfers
{

using test::bonded_laws;
using test::path_of_t;
using test::peeled;
using test::peeled_mesh;
using test::ProblemData;

inline adapt::Method method_of(int degree)
{
  adapt::Method method{.degree = degree, .newton = {.tolerance = 1e-12}};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  return method;
}

/// Problem and path of bonded_path.h.
template <int dim>
struct Peeled
{
  Peeled(const problem::ContactLaw& law, bool pairs, int degree, const adapt::PathOptions& options = {})
      : mesh(peeled_mesh<dim>(pairs)),
        problem(peeled<dim>(law, pairs).on(mesh)),
        method(method_of(degree)),
        path(problem, method, options, mesh::Mesh<dim>(peeled_mesh<dim>(pairs)))
  {
  }

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  adapt::Method method;
  adapt::LoadPath<dim> path;
};

template <int dim>
mesh::Mesh<dim> refined(const mesh::Mesh<dim>& mesh)
{
  std::vector<Index> all(mesh.n_cells());
  std::iota(all.begin(), all.end(), 0);
  return std::move(mesh::bisect<dim>(mesh, all).mesh);
}

inline adapt::PathProgram through(std::vector<double> t)
{
  return {.targets = std::move(t)};
}

struct Followed
{
  certify::Verdict verdict{certify::RunStatus::failed, {}};
  std::vector<double> t;
  std::vector<double> bound;  ///< relative to the largest stress so far
  std::vector<std::int64_t> cells;
  std::vector<std::int64_t> meshes;  ///< cells of each, after the first
  int left = 0;
  std::optional<io::LoadStepRecord> record;
  adapt::PathEnd end;
};

template <int dim>
Followed followed(Peeled<dim>& run, const adapt::PathProgram& program, const adapt::Strategy<dim>& strategy)
{
  Followed result;
  const adapt::ReplayObserver<dim> observer{
      .begins = [&](int number, const adapt::Grid<dim>&) { EXPECT_EQ(number, 0); },
      .step =
          [&](const adapt::LoadStep<dim>& step)
      {
        result.t.push_back(step.t);
        result.bound.push_back(step.level.estimate.total_sharp / step.largest_sigma);
        result.cells.push_back(step.at->discrete.mesh.n_cells());
        result.record = io::load_step_record<dim>(step, result.record ? &*result.record : nullptr);
        EXPECT_EQ(step.number, static_cast<int>(result.t.size()));
        EXPECT_EQ(step.level.u.size(), run.path.grid().space.n_dofs());
      },
      .path_end = [&](const adapt::PathEnd& end) { result.end = end; },
      .complete = [&](const adapt::PassView<dim>& mesh)
      { EXPECT_EQ(mesh.number, static_cast<int>(result.meshes.size())); },
      .finer =
          [&](const adapt::PassView<dim>& left, const adapt::Grid<dim>& grid)
      {
        EXPECT_EQ(left.number, result.left++);
        result.meshes.push_back(grid.mesh.n_cells());
      }};
  result.verdict = adapt::transfer<dim>(run.path, program, strategy, observer);
  return result;
}

}  // namespace tribound::transfers
