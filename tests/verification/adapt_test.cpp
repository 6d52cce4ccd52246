/// @file adapt_test.cpp
/// The adaptive algorithm on problem T2D: optimal rates, few Newton steps, and a certificate at the end,
/// whatever happens.

#include "tribound/adapt/loop.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "support/meshes.h"
#include "tribound/base/error.h"
#include "verification/run_adaptively.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

struct Row
{
  int cells;
  double dofs;
  double bound;
  std::size_t newton;
  certify::RunStatus status;
  certify::BoundComponents eta;
  std::optional<int> delta_updates;
  double delta;
};

struct History
{
  std::vector<Row> levels;
  certify::Verdict verdict;
};

/// The last level is not converged further, since the criterion is tested.
adapt::Method method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-12}, .stopping = {.finish = false}};
}

/// Runs T2D from the 4 x 2 mesh; `on_step` is called after every Newton step.
History adapt_t2d(const adapt::Method& method, const adapt::AdaptOptions& options,
                  const adapt::StepObserver& on_step = {}, const std::atomic<bool>& stop = false)
{
  History history;
  const adapt::LoopObserver<2> observer = {
      on_step, [&](const adapt::LevelView<2>& view)
      {
        const adapt::Discretisation<2>& discrete = view.discrete;
        const adapt::CertifiedLevel<2>& level = view.level;
        EXPECT_EQ(view.number, history.levels.size());
        const auto free = fem::n_free_dofs(discrete.space, discrete.form.constraints());
        history.levels.push_back({discrete.mesh.n_cells(), double(free), level.estimate.total_sharp,
                                  level.steps.size(), view.verdict.status, level.estimate.global,
                                  level.delta_updates, level.steps.back().step.delta});
        EXPECT_LE(level.identities.largest(), 1e-10);
      }};
  history.verdict = run_adaptively<2>(block<2>({4, 2}), pressed_block<2>(), method, options, observer, stop);
  return history;
}

adapt::AdaptOptions until(double tolerance)
{
  return {.tolerance = tolerance, .marking = {.theta = 0.6}, .max_levels = 60};
}

/// The least-squares slope of log(bound) over log(dofs) on the levels from `first` dofs on.
double slope(const std::vector<Row>& levels, double first)
{
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Row& row : levels)
  {
    if (row.dofs < first) continue;
    const double a = std::log(row.dofs);
    const double b = std::log(row.bound);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Uniform meshes give about -0.39 for each degree: the ends of the clamped side are singular.
TEST(Adapt, TheBoundHasTheOptimalRateInDofs)
{
  const double tolerances[] = {0.006, 0.0004, 0.00004};
  const double deviations[] = {0.04, 0.06, 0.12};
  for (int p = 1; p <= 3; ++p)
  {
    const History history = adapt_t2d(method(p), until(tolerances[p - 1]));
    EXPECT_EQ(history.verdict.status, certify::RunStatus::certified) << history.verdict.reason;
    const double rate = slope(history.levels, p == 1 ? 1000 : 500);
    EXPECT_NEAR(rate, -p / 2.0, deviations[p - 1]) << "p = " << p;
    // From the carried solution; the first mesh starts from scratch, with contact closed and sticking.
    for (std::size_t level = 1; level < history.levels.size(); ++level)
      EXPECT_LE(history.levels[level].newton, 6u) << "p = " << p << ", level " << level;
    EXPECT_GT(history.levels.size(), 10u);
    RecordProperty("rate_p" + std::to_string(p), std::to_string(rate));
  }
}

/// The bound of every step of the levels of a block in 3D.
std::vector<std::vector<adapt::CertifiedStep>> steps_in_3d(adapt::Stopping criterion)
{
  std::vector<std::vector<adapt::CertifiedStep>> steps;
  const adapt::LoopObserver<3> observer = {
      {},
      [&](const adapt::LevelView<3>& view)
      {
        const adapt::CertifiedLevel<3>& level = view.level;
        steps.push_back(level.steps);
        EXPECT_LE(level.identities.largest(), 1e-10);
        ASSERT_TRUE(level.steps.back().bound);
        const certify::Stress<3> own = level.stress;
        const certify::Estimate eta = certify::estimate<3>(view.discrete.form, level.u, own);
        EXPECT_NEAR(level.steps.back().bound->total_sharp, eta.total_sharp,
                    1e-10 * eta.total_sharp);  // another C_F
      }};
  (void)run_adaptively<3>(block<3>({4, 2, 2}), pressed_block<3>(),
                          {.degree = 1, .stopping = {.criterion = criterion, .finish = false}},
                          {.marking = {.theta = 0.6}, .max_levels = 3}, observer);
  return steps;
}

/// In 3D the patches away from Gamma_C are skipped if sigma_lin shows that the iterate will not do. The kept
/// iterate is still certified by its own stress.
TEST(Adapt, In3DOnlyIteratesThatMayBeKeptGetTheCompleteBound)
{
  int without = 0;
  for (const auto& level : steps_in_3d(adapt::Stopping::adaptive))
    for (const adapt::CertifiedStep& step : level)
    {
      ASSERT_TRUE(step.linearisation);
      EXPECT_TRUE(step.bound || !step.accepted);
      without += step.bound ? 0 : 1;
    }
  EXPECT_GT(without, 2);
  for (const auto& level : steps_in_3d(adapt::Stopping::tolerance))
    for (const adapt::CertifiedStep& step : level) EXPECT_TRUE(step.bound);
}

/// Prints the table of the regularised variant: delta updates and Newton steps per level.
void print_regularised(int p, const History& history)
{
  fmt::print(
      "T2D, p = {}\nlevel  cells   dofs  N_reg  N_lin      delta  eta_reg/rest  eta_lin/rest      bound\n",
      p);
  int number = 0;
  for (const Row& row : history.levels)
    fmt::print("{:>5} {:>6} {:>6} {:>6} {:>6} {:>10.3e} {:>13.3f} {:>13.3f} {:>10.4e}\n", number++, row.cells,
               row.dofs, row.delta_updates.value_or(0), row.newton, row.delta,
               row.eta.regularisation() / row.eta.discretisation(),
               row.eta.linearisation() / row.eta.discretisation(), row.bound);
}

TEST(Adapt, TheRegularisedVariantHasTheRateOfThePlainMethod)
{
  const double tolerances[] = {0.012, 0.0008, 0.0001};
  const double deviations[] = {0.04, 0.06, 0.12};
  for (int p = 1; p <= 3; ++p)
  {
    const History plain = adapt_t2d(method(p), until(tolerances[p - 1]));
    adapt::Method regularised = method(p);
    regularised.regularisation.emplace();
    const History history = adapt_t2d(regularised, until(tolerances[p - 1]));
    print_regularised(p, history);
    EXPECT_EQ(history.verdict.status, certify::RunStatus::certified) << history.verdict.reason;
    const double first = p == 1 ? 1000 : 500;
    EXPECT_NEAR(slope(history.levels, first), slope(plain.levels, first), deviations[p - 1]) << "p = " << p;
    for (const Row& row : history.levels)
    {
      EXPECT_LE(row.eta.regularisation(), 0.1 * row.eta.discretisation());
      EXPECT_TRUE(adapt::linearisation_is_negligible(row.eta, 0.1));
    }
    EXPECT_NEAR(history.levels.back().dofs, plain.levels.back().dofs, 0.3 * plain.levels.back().dofs);
  }
}

TEST(Adapt, OnTheGivenMeshOnlyItCertifiesAndStops)
{
  const History history = adapt_t2d(method(2), {.max_levels = 0});
  EXPECT_EQ(history.levels.size(), 1u);
  EXPECT_EQ(history.verdict.status, certify::RunStatus::budget);
  EXPECT_THAT(history.verdict.reason, HasSubstr("adapt.max_levels = 0 is reached"));
}

TEST(Adapt, KeepsToEveryLimit)
{
  const History cells = adapt_t2d(method(1), {.max_cells = 300});
  EXPECT_LE(cells.levels.back().cells, 300);
  EXPECT_THAT(cells.verdict.reason, HasSubstr("more than adapt.max_cells = 300"));
  const History dofs = adapt_t2d(method(1), {.max_dofs = 300});
  EXPECT_LE(dofs.levels.back().dofs, 300);
  EXPECT_THAT(dofs.verdict.reason, HasSubstr("more than adapt.max_dofs = 300"));
  const History time = adapt_t2d(method(1), {.max_time = 1e-9});
  EXPECT_EQ(time.levels.size(), 1u);
  EXPECT_THAT(time.verdict.reason, HasSubstr("adapt.max_time"));
  const History memory = adapt_t2d(method(1), {.max_memory = 1e-6});
  EXPECT_EQ(memory.levels.size(), 1u);
  EXPECT_THAT(memory.verdict.reason, HasSubstr("more than adapt.max_memory = 1e-06 GB"));
  for (const History* history : {&cells, &dofs, &time, &memory})
    EXPECT_EQ(history->verdict.status, certify::RunStatus::budget);
}

TEST(Adapt, MaximumMarkingReachesTheToleranceToo)
{
  const History history = adapt_t2d(
      method(2), {.tolerance = 0.02, .marking = {.strategy = adapt::Marking::maximum}, .max_levels = 60});
  EXPECT_EQ(history.verdict.status, certify::RunStatus::certified) << history.verdict.reason;
}

/// The contact part is a tenth to a half of the bound here, so its facets are refined separately.
TEST(Adapt, SeparateMarkingReachesTheToleranceToo)
{
  const auto run = [](bool separately)
  {
    return adapt_t2d(method(2),
                     {.tolerance = 0.02, .marking = {.separate_contact = separately}, .max_levels = 60});
  };
  const History together = run(false);
  const History separate = run(true);
  EXPECT_EQ(separate.verdict.status, certify::RunStatus::certified) << separate.verdict.reason;
  EXPECT_LE(separate.levels.size(), together.levels.size());
  EXPECT_LE(separate.levels.back().dofs, 1.5 * together.levels.back().dofs);
}

/// The criterion on every cell takes more steps than the global one, fewer than convergence to the last
/// digit.
TEST(Adapt, TheLocalCriterionTakesStepsBetweenTheOthers)
{
  const auto steps = [](adapt::Stopping stopping)
  {
    adapt::Method stopped = method(1);
    stopped.stopping.criterion = stopping;
    const History history =
        adapt_t2d(stopped, {.tolerance = 0.05, .marking = {.theta = 0.5}, .max_levels = 60});
    EXPECT_EQ(history.verdict.status, certify::RunStatus::certified);
    std::size_t sum = 0;
    for (const Row& row : history.levels) sum += row.newton;
    return double(sum) / double(history.levels.size());
  };
  const double global = steps(adapt::Stopping::adaptive);
  const double local = steps(adapt::Stopping::adaptive_local);
  const double converged = steps(adapt::Stopping::tolerance);
  EXPECT_LE(global, local);
  EXPECT_LT(local, converged);
  EXPECT_LT(global, converged);
}

TEST(Adapt, ExpectedMemoryGrowsFasterThanTheUnknowns)
{
  EXPECT_EQ(adapt::expected_memory(100, 100, 3, 2), 100);
  EXPECT_DOUBLE_EQ(adapt::expected_memory(100, 300, 1, 3), 300);
  EXPECT_GT(adapt::expected_memory(100, 300, 2, 2), 500);
  EXPECT_DOUBLE_EQ(adapt::expected_memory(100, 300, 8, 3), 100 + 200 * 16);
}

TEST(Adapt, InterruptedItKeepsTheLastCompleteLevel)
{
  std::atomic<bool> stop = false;
  int steps_in_all = 0;
  const History history = adapt_t2d(
      method(1), {}, [&](const adapt::CertifiedStep&) { stop = ++steps_in_all > 12; }, stop);
  EXPECT_FALSE(history.levels.empty());
  EXPECT_EQ(history.verdict.status, certify::RunStatus::budget);
  EXPECT_THAT(history.verdict.reason, HasSubstr("interrupted"));
}

TEST(Adapt, ALaterLevelThatFailsLeavesTheCertificateOfTheOneBefore)
{
  int first_steps = 0;
  const History history = adapt_t2d(method(1), {},
                                    [&](const adapt::CertifiedStep& step)
                                    {
                                      first_steps += step.step.step == 1 ? 1 : 0;
                                      if (first_steps == 3) throw SolveError("the matrix is singular");
                                    });
  EXPECT_EQ(history.levels.size(), 2u);
  EXPECT_EQ(history.verdict.status, certify::RunStatus::budget);
  EXPECT_THAT(history.verdict.reason, HasSubstr("this is level 1, level 2 failed: the matrix is singular"));
}

TEST(Adapt, WithoutTheFirstLevelThereIsNoCertificate)
{
  EXPECT_THROW(adapt_t2d(method(1), {}, [](const adapt::CertifiedStep&) { throw SolveError("singular"); }),
               SolveError);
  adapt::Method one_step = method(1);
  one_step.newton.max_steps = 1;  // leaves a linearisation error
  const History history = adapt_t2d(one_step, {});
  EXPECT_EQ(history.levels.size(), 1u);
  EXPECT_EQ(history.verdict.status, certify::RunStatus::failed);
}

TEST(Adapt, LinearisationIsNegligibleOnTheWholeOrOnEveryCell)
{
  certify::Estimate estimate;
  estimate.cells.resize(2);
  estimate.cells[0].str = estimate.global.str = 1;
  estimate.cells[1].lin1 = estimate.global.lin1 = 0.05;
  EXPECT_TRUE(adapt::linearisation_is_negligible(estimate, {.criterion = adapt::Stopping::adaptive}));
  EXPECT_FALSE(adapt::linearisation_is_negligible(estimate, {.criterion = adapt::Stopping::adaptive_local}));
  EXPECT_FALSE(adapt::linearisation_is_negligible(estimate, {.criterion = adapt::Stopping::tolerance}));
  estimate.cells[1].cnt = 0.5;
  EXPECT_TRUE(adapt::linearisation_is_negligible(estimate, {.criterion = adapt::Stopping::adaptive_local}));
}

TEST(Adapt, LinearisationIsNegligibleWhenItsPartsAre)
{
  certify::BoundComponents eta;
  eta.str = 0.6;
  eta.cnt = 0.4;
  EXPECT_TRUE(adapt::linearisation_is_negligible(eta, 0.1));
  eta.lin1 = eta.lin2n = eta.lin2t = 0.033;
  EXPECT_TRUE(adapt::linearisation_is_negligible(eta, 0.1));
  eta.lin2n = 0.035;
  EXPECT_FALSE(adapt::linearisation_is_negligible(eta, 0.1));
}

}  // namespace

}  // namespace tribound::test
