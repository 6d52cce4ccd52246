/// @file adapt_test.cpp
/// The adaptive algorithm on problem T2D: optimal rates, few Newton steps, and the certificate it ends with
/// whatever happens.

#include "adapt/loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/gmsh.h"
#include "support/t2d.h"

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
  RunStatus status;
};

struct History
{
  std::vector<Row> levels;
  Verdict verdict;
};

/// Runs T2D from the 4 x 2 mesh; `on_step` is called after every Newton step.
History adapt_t2d(int p, const std::string& keys, std::atomic<bool>& stop, const StepObserver& on_step = {},
                  int max_steps = 50)
{
  Config config = parse_config(t2d_toml(p, 4, 2) + keys);
  config.newton.damping = true;
  config.newton.max_steps = max_steps;
  auto mesh = std::get<Mesh<2>>(read_mesh(config.mesh));
  const Problem<2> problem(config, mesh.region_names(), mesh.boundary_names());
  History history;
  const LoopObserver<2> observer = {
      on_step, [&](const LevelView<2>& view)
      {
        const auto& [number, discrete, level, verdict, seconds] = view;
        EXPECT_EQ(number, history.levels.size());
        const int fixed = discrete.form.constraints().n_fixed();
        history.levels.push_back({discrete.mesh.n_cells(), double(discrete.space.n_dofs() - fixed),
                                  level.estimate.total_sharp, level.steps.size(), verdict.status});
        EXPECT_LE(level.identities.largest(p), 1e-10);
      }};
  history.verdict = adapt<2>(
      problem, config, std::make_unique<Discretisation<2>>(std::move(mesh), problem, config), observer, stop);
  return history;
}

History adapt_t2d(int p, const std::string& keys)
{
  std::atomic<bool> stop = false;
  return adapt_t2d(p, keys, stop);
}

/// The slope of log(bound) over log(dofs), least squares over the levels from `first` dofs on.
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

/// Uniform meshes give about -0.39 in each degree: singular at the ends of the clamped side.
TEST(Adapt, TheBoundHasTheOptimalRateInDofs)
{
  const double tolerances[] = {0.006, 0.0004, 0.00004};
  const double deviations[] = {0.04, 0.06, 0.12};
  for (int p = 1; p <= 3; ++p)
  {
    const History history = adapt_t2d(
        p, "adapt = { theta = 0.6, max_levels = 60, tolerance = " + std::to_string(tolerances[p - 1]) + " }");
    EXPECT_EQ(history.verdict.status, RunStatus::certified) << history.verdict.reason;
    const double rate = slope(history.levels, p == 1 ? 1000 : 500);
    EXPECT_NEAR(rate, -p / 2.0, deviations[p - 1]) << "p = " << p;
    // From the carried solution; the first mesh starts from scratch, from a closed and sticking contact.
    for (std::size_t level = 1; level < history.levels.size(); ++level)
      EXPECT_LE(history.levels[level].newton, 6u) << "p = " << p << ", level " << level;
    EXPECT_GT(history.levels.size(), 10u);
    RecordProperty("rate_p" + std::to_string(p), std::to_string(rate));
  }
}

TEST(Adapt, OnTheGivenMeshOnlyItCertifiesAndStops)
{
  const History history = adapt_t2d(2, "adapt.max_levels = 0\n");
  EXPECT_EQ(history.levels.size(), 1u);
  EXPECT_EQ(history.verdict.status, RunStatus::budget);
  EXPECT_THAT(history.verdict.reason, HasSubstr("adapt.max_levels = 0 is reached"));
}

TEST(Adapt, KeepsToEveryLimit)
{
  const History cells = adapt_t2d(1, "adapt.max_cells = 300\n");
  EXPECT_LE(cells.levels.back().cells, 300);
  EXPECT_THAT(cells.verdict.reason, HasSubstr("more than adapt.max_cells = 300"));
  const History dofs = adapt_t2d(1, "adapt.max_dofs = 300\n");
  EXPECT_LE(dofs.levels.back().dofs, 300);
  EXPECT_THAT(dofs.verdict.reason, HasSubstr("more than adapt.max_dofs = 300"));
  const History time = adapt_t2d(1, "adapt.max_time = 1e-9\n");
  EXPECT_EQ(time.levels.size(), 1u);
  EXPECT_THAT(time.verdict.reason, HasSubstr("adapt.max_time"));
  for (const History* history : {&cells, &dofs, &time}) EXPECT_EQ(history->verdict.status, RunStatus::budget);
}

TEST(Adapt, MaximumMarkingReachesTheToleranceToo)
{
  const History history =
      adapt_t2d(2, "adapt = { marking = \"maximum\", theta = 0.5, tolerance = 0.02, max_levels = 60 }");
  EXPECT_EQ(history.verdict.status, RunStatus::certified) << history.verdict.reason;
}

TEST(Adapt, InterruptedItKeepsTheLastCompleteLevel)
{
  std::atomic<bool> stop = false;
  int steps_in_all = 0;
  const History history = adapt_t2d(1, "", stop, [&](const CertifiedStep&) { stop = ++steps_in_all > 12; });
  EXPECT_FALSE(history.levels.empty());
  EXPECT_EQ(history.verdict.status, RunStatus::budget);
  EXPECT_THAT(history.verdict.reason, HasSubstr("interrupted"));
}

TEST(Adapt, ALaterLevelThatFailsLeavesTheCertificateOfTheOneBefore)
{
  std::atomic<bool> stop = false;
  int first_steps = 0;
  const History history = adapt_t2d(1, "", stop,
                                    [&](const CertifiedStep& step)
                                    {
                                      if (step.step.step == 1 && ++first_steps == 3)
                                        throw SolveError("the matrix is singular");
                                    });
  EXPECT_EQ(history.levels.size(), 2u);
  EXPECT_EQ(history.verdict.status, RunStatus::budget);
  EXPECT_THAT(history.verdict.reason, HasSubstr("this is level 1, level 2 failed: the matrix is singular"));
}

TEST(Adapt, WithoutTheFirstLevelThereIsNoCertificate)
{
  std::atomic<bool> stop = false;
  EXPECT_THROW(adapt_t2d(1, "", stop, [](const CertifiedStep&) { throw SolveError("singular"); }),
               SolveError);
  const History history = adapt_t2d(1, "", stop, {}, 1);  // one step leaves a linearisation error
  EXPECT_EQ(history.levels.size(), 1u);
  EXPECT_EQ(history.verdict.status, RunStatus::failed);
}

TEST(Adapt, LinearisationIsNegligibleWhenItsPartsAre)
{
  BoundComponents eta;
  eta.str = 0.6;
  eta.cnt = 0.4;
  EXPECT_TRUE(linearisation_is_negligible(eta, 0.1));
  eta.lin1 = eta.lin2n = eta.lin2t = 0.033;
  EXPECT_TRUE(linearisation_is_negligible(eta, 0.1));
  eta.lin2n = 0.035;
  EXPECT_FALSE(linearisation_is_negligible(eta, 0.1));
}

}  // namespace

}  // namespace tribound::test
