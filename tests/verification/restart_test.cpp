/// @file restart_test.cpp
/// Load paths that continue from any of their steps as if uninterrupted.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "support/bonded_path.h"
#include "support/snap_back_bar.h"
#include "tribound/io/state/path_checkpoint.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test::restart_test_cases
{
namespace
{

/// The data of a step that are compared.
struct Told
{
  int pass;
  int number;
  double t;
  double bound;
  double damage;
  double work;
};

struct Followed
{
  certify::Verdict verdict{certify::RunStatus::failed, {}};
  std::vector<Told> steps;
  std::vector<std::filesystem::path> left;  ///< a checkpoint after each step
  adapt::PathEnd end;
  int worst = 0;
};

/// A path on finer and finer meshes.
template <int dim>
struct Case
{
  mesh::MeshData<dim> mesh;
  problem::Problem<dim> problem;
  adapt::Method method{};
  adapt::PathProgram program{};
  int max_levels = 0;
};

template <int dim>
std::unique_ptr<adapt::LoadPath<dim>> path_on(const Case<dim>& of, mesh::Mesh<dim> mesh)
{
  return std::make_unique<adapt::LoadPath<dim>>(of.problem, of.method, adapt::PathOptions{.tolerance = 1e-6},
                                                std::move(mesh));
}

/// Runs from the beginning or from a checkpoint.
template <int dim>
Followed run(const Case<dim>& of, const std::filesystem::path& checkpoint = {})
{
  const mesh::Mesh<dim> first(mesh::MeshData<dim>(of.mesh));
  std::unique_ptr<adapt::LoadPath<dim>> path;
  std::optional<adapt::ReplayState<dim>> from;
  if (checkpoint.empty())
    path = path_on(of, mesh::Mesh<dim>(mesh::MeshData<dim>(of.mesh)));
  else
  {
    const io::CheckpointFacts facts = io::read_checkpoint_facts(checkpoint, {});
    io::CheckpointCells<dim> read = io::read_checkpoint_cells<dim>(checkpoint, facts, {});
    mesh::Balanced<dim> restored =
        mesh::restore<dim>({}, &first, std::move(read.cells), read.values, io::n_values_of_cell(facts));
    path = path_on(of, std::move(restored.mesh));
    from = io::from_checkpoint<dim>(facts, path->grid().space, restored.cells, restored.values, read.points);
  }
  Followed result;
  const adapt::Grid<dim>* grid = nullptr;
  int pass = 0;
  const adapt::ReplayObserver<dim> observer{
      .begins =
          [&](int number, const adapt::Grid<dim>& on)
      {
        pass = number;
        grid = &on;
      },
      .step =
          [&](const adapt::LoadStep<dim>& step)
      {
        result.steps.push_back({pass, step.number, step.t,
                                step.level.estimate.total_sharp / step.largest_sigma, integrals(step).damage,
                                step.work});
      },
      .state =
          [&](const adapt::ReplayState<dim>& state)
      {
        if (!checkpoint.empty()) return;
        result.left.push_back(
            fmt::format("{}/restart_{}_{}.h5", testing::TempDir(), getpid(), result.left.size()));
        io::CheckpointFacts facts{.dimension = dim, .degree = of.method.degree};
        const io::CheckpointFields fields = io::to_checkpoint(state, facts);
        io::write_checkpoint<dim>(result.left.back(), facts, grid->space, fields);
      },
      .path_end = [&](const adapt::PathEnd& end) { result.end = end; },
      .complete = [&](const adapt::PassView<dim>& view) { result.worst = view.worst; }};
  const adapt::AdaptOptions options{.tolerance = 1e-6, .max_levels = of.max_levels};
  result.verdict = adapt::replay<dim>(std::move(path), of.program, adapt::make_strategy<dim>(options),
                                      observer, from ? &*from : nullptr);
  return result;
}

void expect_the_same(const Followed& whole, const Followed& rest)
{
  EXPECT_EQ(rest.verdict.reason, whole.verdict.reason);
  EXPECT_EQ(rest.end.failure, whole.end.failure);
  if (whole.steps.back().bound > 1e-6)
  {
    EXPECT_EQ(rest.worst, whole.worst);
  }
  ASSERT_EQ(rest.end.peak.has_value(), whole.end.peak.has_value());
  if (whole.end.peak)
  {
    EXPECT_NEAR(rest.end.peak->t, whole.end.peak->t, 1e-9 * whole.end.peak->t);
    EXPECT_EQ(rest.end.peak->number, whole.end.peak->number);
  }
  ASSERT_LE(rest.steps.size(), whole.steps.size());
  const std::span<const Told> expected = std::span(whole.steps).last(rest.steps.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const Told& is = rest.steps[i];
    const Told& was = expected[i];
    SCOPED_TRACE(was.number);
    EXPECT_EQ(is.pass, was.pass);
    EXPECT_EQ(is.number, was.number);
    EXPECT_NEAR(is.t, was.t, 1e-9 * std::abs(was.t));
    EXPECT_NEAR(is.bound, was.bound, 1e-7 * was.bound + 1e-9);
    EXPECT_NEAR(is.damage, was.damage, 1e-8);
    EXPECT_NEAR(is.work, was.work, 1e-7 * std::abs(was.work) + 1e-10);
  }
}

/// Restarts from one in `every` steps.
template <int dim>
void expect_to_go_on(const Case<dim>& of, std::size_t every)
{
  const Followed whole = run(of);
  ASSERT_GT(whole.left.size(), every);
  for (std::size_t i = every / 2; i < whole.left.size(); i += every)
  {
    SCOPED_TRACE(i);
    const Followed rest = run(of, whole.left[i]);
    EXPECT_EQ(rest.steps.size(), whole.steps.size() - i - 1);
    expect_the_same(whole, rest);
  }
  std::ranges::for_each(whole.left, [](const auto& file) { std::filesystem::remove(file); });
}

template <int dim>
Case<dim> peeled_case(const problem::ContactLaw& law, bool pairs)
{
  const mesh::MeshData<dim> mesh = peeled_mesh<dim>(pairs);
  Case<dim> of{.mesh = mesh,
               .problem = peeled<dim>(law, pairs).on(mesh::Mesh<dim>(mesh::MeshData<dim>(mesh))),
               .method = {.degree = dim == 2 ? 2 : 1},
               .program = {.targets = {path_of_t.begin(), path_of_t.end()}},
               .max_levels = 1};
  of.method.stopping.criterion = adapt::Stopping::last_bounded;
  of.method.newton.tolerance = 1e-12;
  return of;
}

TEST(Restart, EveryLawGoesOnInAnyPass)
{
  for (const problem::ContactLaw& law : bonded_laws())
  {
    SCOPED_TRACE(problem::words(law));
    expect_to_go_on(peeled_case<2>(law, false), 5);
  }
}

TEST(Restart, Pairs)
{
  expect_to_go_on(peeled_case<2>(bonded_laws()[1], true), 4);
}

TEST(Restart, In3D)
{
  expect_to_go_on(peeled_case<3>(bonded_laws()[3], false), 4);
}

/// Restarts before, at and after the peak; the search for the peak uses the steps before it.
TEST(Restart, InTheMiddleOfASnapBack)
{
  const Bar<2> bar(2);
  expect_to_go_on(Case<2>{.mesh = bar.mesh,
                          .problem = bar.problem,
                          .method = bar.method,
                          .program = {.targets = {0.0009, 0.0017, 0.003},
                                      .following = adapt::Following::automatic,
                                      .damage_step = 0.1}},
                  1);
}

/// The list of load factors may be longer than before.
TEST(Restart, FurtherSteps)
{
  Case<2> of = peeled_case<2>(bonded_laws()[1], false);
  of.max_levels = 0;
  const Followed all = run(of);
  of.program.targets.resize(2);
  const Followed some = run(of);
  of.program.targets = {path_of_t.begin(), path_of_t.end()};
  const Followed rest = run(of, some.left.back());
  EXPECT_EQ(rest.steps.size(), all.steps.size() - some.steps.size());
  expect_the_same(all, rest);
}

}  // namespace
}  // namespace tribound::test::restart_test_cases
