/// @file replay_test.cpp
/// Load paths followed on finer and finer meshes until every step meets its tolerance.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "support/bonded_path.h"
#include "tribound/adapt/replay.h"
#include "tribound/contact/nitsche/interface_check.h"
#include "tribound/io/record/load_step_record.h"

namespace tribound::test
{
namespace
{

struct Pass
{
  std::int64_t cells = 0;
  std::vector<double> t;
  std::vector<double> bound;  ///< relative to the largest stress so far
  double worst = 0;
};

struct Replayed
{
  certify::Verdict verdict{certify::RunStatus::failed, {}};
  std::vector<Pass> passes;
  int given_up = 0;
};

adapt::Method method_of(int degree)
{
  adapt::Method method{.degree = degree};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  return method;
}

/// The path of bonded_path.h; `stop` becomes true after the given number of steps.
template <int dim>
Replayed replayed(const problem::ContactLaw& law, const adapt::AdaptOptions& options, bool pairs,
                  int steps_before_stop = 1'000'000)
{
  mesh::Mesh<dim> mesh(peeled_mesh<dim>(pairs));
  const problem::Problem<dim> problem = peeled<dim>(law, pairs).on(mesh);
  const adapt::Method method = method_of(2);
  std::atomic<bool> stop = false;
  int steps = 0;
  Replayed result;
  const adapt::ReplayObserver<dim> observer{
      .begins =
          [&](int number, const adapt::Grid<dim>& grid)
      {
        EXPECT_EQ(number, static_cast<int>(result.passes.size()));
        result.passes.push_back({grid.mesh.n_cells()});
      },
      .step =
          [&](const adapt::LoadStep<dim>& step)
      {
        result.passes.back().t.push_back(step.t);
        result.passes.back().bound.push_back(step.level.estimate.total_sharp / step.largest_sigma);
        stop = ++steps >= steps_before_stop;
      },
      .complete = [&](const adapt::PassView<dim>& pass)
      { result.passes.back().worst = pass.bound.total_sharp; },
      .given_up = [&] { return ++result.given_up > 0; }};
  result.verdict = adapt::replay<dim>(
      std::make_unique<adapt::LoadPath<dim>>(
          problem, method, adapt::PathOptions{.tolerance = options.tolerance}, std::move(mesh), &stop),
      adapt::PathProgram{.targets = {path_of_t.begin(), path_of_t.end()}}, adapt::make_strategy<dim>(options),
      observer);
  return result;
}

TEST(Replay, RefinesUntilEveryStepHasTheTolerance)
{
  for (const bool pairs : {false, true})
  {
    const Replayed run = replayed<2>(bonded_laws()[3], {.tolerance = 0.04}, pairs);
    EXPECT_EQ(run.verdict.status, certify::RunStatus::certified) << run.verdict.reason;
    EXPECT_GT(run.passes.size(), 2U);
    for (const double bound : run.passes.back().bound) EXPECT_LE(bound, 0.04);
    EXPECT_EQ(run.passes.back().t.back(), path_of_t.back());
    for (std::size_t i = 1; i < run.passes.size(); ++i)
    {
      EXPECT_GT(run.passes[i].cells, run.passes[i - 1].cells);
      EXPECT_THAT(run.passes[i - 1].bound, testing::Contains(testing::Gt(0.04)));
    }
    EXPECT_LT(run.passes.back().worst, run.passes.front().worst);
  }
}

TEST(Replay, EndsAtALimit)
{
  const Replayed run = replayed<2>(bonded_laws()[0], {.tolerance = 1e-6, .max_levels = 1}, false);
  EXPECT_EQ(run.verdict.status, certify::RunStatus::budget);
  EXPECT_EQ(run.passes.size(), 2U);
  EXPECT_THAT(run.verdict.reason,
              testing::AllOf(testing::HasSubstr("load step "), testing::HasSubstr("adapt.max_levels = 1")));
}

TEST(Replay, APassThatIsInterruptedLeavesTheOneBefore)
{
  const auto n = static_cast<int>(path_of_t.size());
  const Replayed run = replayed<2>(bonded_laws()[5], {.tolerance = 1e-6, .max_levels = 3}, false, n + 2);
  EXPECT_EQ(run.verdict.status, certify::RunStatus::budget);
  EXPECT_EQ(run.given_up, 1);
  EXPECT_THAT(run.verdict.reason, testing::HasSubstr("this is pass 0, pass 1 failed: interrupted"));

  const Replayed first = replayed<2>(bonded_laws()[5], {.tolerance = 1e-6}, false, 2);
  EXPECT_EQ(first.verdict.status, certify::RunStatus::failed);
  EXPECT_EQ(first.given_up, 0);
  EXPECT_THAT(first.verdict.reason, testing::HasSubstr("interrupted at t = 1.1"));
}

/// The work of loads and reactions goes into bodies, interface and dissipation, up to the error of the
/// trapezoidal rule, which falls with the square of the steps.
TEST(Replay, EnergiesBalance)
{
  for (const std::size_t i : {1, 3, 4})
  {
    const problem::ContactLaw law = bonded_laws()[i];
    SCOPED_TRACE(problem::words(law));
    std::vector<double> balance;
    for (const int n : {4, 16})
    {
      mesh::Mesh<2> mesh(peeled_mesh<2>(false));
      const problem::Problem<2> problem = peeled<2>(law, false).on(mesh);
      const adapt::Method method = method_of(2);
      adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
      std::optional<io::LoadStepRecord> record;
      for (int k = 1; k <= n; ++k)
        ASSERT_EQ(path.advance(1.5 * k / n, [&](const adapt::LoadStep<2>& step)
                               { record = io::load_step_record<2>(step, record ? &*record : nullptr); }),
                  "");
      EXPECT_GT(record->work, 0);
      EXPECT_GE(record->dissipated, record->rubbed);
      balance.push_back(std::abs(record->balance) / record->work);
    }
    EXPECT_LE(balance[1], 0.02);
    EXPECT_LE(balance[1], std::max(0.5 * balance[0], 2e-3));
  }
}

TEST(Replay, BondsAreBrokenFromTheBeginning)
{
  mesh::Mesh<2> mesh(peeled_mesh<2>(false));
  ProblemData<2> data = peeled<2>(bonded_laws()[0], false);
  data.boundaries.back().contact->broken = formula("x < 1");
  const problem::Problem<2> problem = data.on(mesh);
  const adapt::Method method = method_of(1);
  adapt::LoadPath<2> path(problem, method, {}, std::move(mesh));
  double broken = 0;
  ASSERT_EQ(path.advance(1e-6, [&](const adapt::LoadStep<2>& step)
                         { broken = io::load_step_record<2>(step, nullptr).all.broken; }),
            "");
  EXPECT_NEAR(broken, 1, 1e-12);
  const contact::NitscheForm<2>& form = path.last()->at->discrete.form;
  for (const contact::ContactPoint<2>& point : form.contact_points())
    EXPECT_EQ(point.state.damage, point.x[0] < 1 ? 1 : 0);
}

}  // namespace
}  // namespace tribound::test
