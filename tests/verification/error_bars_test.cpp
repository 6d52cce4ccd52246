/// @file error_bars_test.cpp
/// The bound of the energy-norm error along the adaptive algorithm: optimal rates and effectivities on meshes
/// that it marks, on the requested meshes, for the kept iterate, and as a demand.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "support/two_blocks.h"
#include "tribound/adapt/loop.h"
#include "tribound/adapt/rate.h"
#include "tribound/certify/truth/solution_error.h"

namespace tribound::test
{

namespace
{

using adapt::EnergyLevels;
using adapt::ErrorMeasure;

/// What an observer was told of a level.
struct ToldLevel
{
  int number;
  std::shared_ptr<const adapt::Discretisation<2>> discrete;
  adapt::CertifiedLevel<2> level;
  certify::Verdict verdict;
};

struct Told
{
  std::shared_ptr<const problem::Problem<2>> problem;  ///< which the levels refer to
  std::vector<ToldLevel> levels;
  certify::Verdict verdict;
};

Told run(const adapt::Method& method, const adapt::AdaptOptions& options,
         const ProblemData<2>& data = pressed_block<2>(), const std::atomic<bool>& stop = false,
         mesh::MeshData<2> mesh_data = block<2>({4, 2}))
{
  mesh::Mesh<2> mesh(std::move(mesh_data));
  Told told{.problem = std::make_shared<const problem::Problem<2>>(data.on(mesh))};
  auto first = std::make_unique<adapt::Discretisation<2>>(std::move(mesh), *told.problem, method);
  const adapt::LoopObserver<2> observer{
      {},
      [&](const adapt::LevelView<2>& view)
      {
        told.levels.push_back({view.number, view.owner, view.level, view.verdict});
        told.levels.back().level.equilibrium.reset();  // factors, which cannot outlive MPI
      }};
  told.verdict = adapt::adapt<2>(*told.problem, method, options, std::move(first), observer, stop);
  return told;
}

/// Rates over all meshes whose cells this bound marks, against a much richer solution.
void expect_optimal(const Told& told, const ToldLevel& reference, int p)
{
  std::vector<adapt::RatePoint> bounds;
  std::vector<adapt::RatePoint> errors;
  double smallest = HUGE_VAL;
  double largest = 0;
  for (const auto& [number, discrete, level, verdict] : told.levels)
  {
    ASSERT_TRUE(level.energy.has_value());
    ASSERT_EQ(level.energy->reason, "") << number;
    const auto dofs = static_cast<double>(fem::n_free_dofs(discrete->space, discrete->form.constraints()));
    const double error = certify::solution_error<2>(discrete->form.problem(), discrete->space, level.u,
                                                    reference.discrete->space, reference.level.u)
                             .global.energy;
    bounds.push_back({dofs, level.energy->bound});
    errors.push_back({dofs, error});
    smallest = std::min(smallest, level.energy->bound / error);
    largest = std::max(largest, level.energy->bound / error);
  }
  const double bound_rate = adapt::fitted_rate(bounds).value();
  const double error_rate = adapt::fitted_rate(errors).value();
  fmt::print(
      "p = {}: {} levels, {:.0f} dofs, bound {:.3e}, rates of bound {:.3f} and error {:.3f}, effectivity "
      "{:.3f} to {:.3f}\n",
      p, told.levels.size(), bounds.back().dofs, bounds.back().value, bound_rate, error_rate, smallest,
      largest);
  EXPECT_GE(smallest, 1);
  EXPECT_LE(largest, 1.5);
  EXPECT_LE(bound_rate, -0.9 * p / 2);
}

adapt::AdaptOptions marked_by_energy(int max_dofs)
{
  return {.tolerance = 1e-9,
          .measure = ErrorMeasure::energy,
          .bars = {.levels = EnergyLevels::every},
          .max_levels = 40,
          .max_dofs = max_dofs};
}

class EnergyAdaptive : public ::testing::TestWithParam<int>
{
};

TEST_P(EnergyAdaptive, RatesAreOptimalOnMeshesThatItMarks)
{
  static const Told reference = run({.degree = 4}, {.tolerance = 1e-4, .max_levels = 40});
  const int p = GetParam();
  expect_optimal(run({.degree = p}, marked_by_energy(p == 1 ? 8000 : 3000)), reference.levels.back(), p);
}

/// Matching facets stay matching, so there is a bound on every mesh.
TEST_P(EnergyAdaptive, RatesAreOptimalBetweenBodies)
{
  const ProblemData<2> data{
      .boundaries = {clamped<2>("left"), clamped<2>("left_below"), loaded<2>("top", 0, -0.1),
                     loaded<2>("right", 0.04, 0.06, 0.02), clamped<2>("bottom_below")},
      .pairs = {pair<2>("bottom", "top_below", Tresca(0.03))}};
  const auto on_blocks = [&](int degree, const adapt::AdaptOptions& options)
  { return run({.degree = degree}, options, data, false, matching_blocks<2>()); };
  static const Told reference = on_blocks(4, {.tolerance = 2e-4, .max_levels = 40});
  const int p = GetParam();
  expect_optimal(on_blocks(p, marked_by_energy(p == 1 ? 8000 : 3000)), reference.levels.back(), p);
}

INSTANTIATE_TEST_SUITE_P(Degrees, EnergyAdaptive, ::testing::Range(1, 4));

TEST(ErrorBars, AreThoseOfTheMeshesThatAreAskedFor)
{
  for (const EnergyLevels levels : {EnergyLevels::off, EnergyLevels::last, EnergyLevels::every})
  {
    const Told told = run({.degree = 2}, {.tolerance = 1e-9, .bars = {.levels = levels}, .max_levels = 3});
    ASSERT_EQ(told.levels.back().number, 3);
    for (const auto& [number, discrete, level, verdict] : told.levels)
      EXPECT_EQ(level.energy.has_value(),
                levels == EnergyLevels::every || (levels == EnergyLevels::last && number == 3));
  }
}

/// A level is known to be the last only when the next mesh turns out too large: it is reported again, with
/// the bar of its final iterate.
TEST(ErrorBars, AreThoseOfTheIterateThatIsKept)
{
  for (const EnergyLevels levels : {EnergyLevels::last, EnergyLevels::every})
  {
    const Told told = run({.degree = 2}, {.tolerance = 1e-9, .bars = {.levels = levels}, .max_dofs = 600});
    const ToldLevel& last = told.levels.back();
    if (levels == EnergyLevels::last)
    {
      ASSERT_EQ(told.levels[told.levels.size() - 2].number, last.number);
    }
    ASSERT_TRUE(last.level.converged && last.level.energy);
    const certify::EnergyBound again =
        adapt::energy_bound<2>(last.discrete->form, {.degree = 2}, last.level.u);
    EXPECT_NEAR(last.level.energy->bound, again.bound, 1e-9 * again.bound);
  }
}

TEST(ErrorBars, ADemandIsPartOfTheVerdict)
{
  const adapt::ErrorBars bars{.levels = EnergyLevels::every, .energy_tolerance = 0.02};
  const Told met = run({.degree = 2}, {.tolerance = 0.5, .bars = bars});
  EXPECT_EQ(met.verdict.status, certify::RunStatus::certified) << met.verdict.reason;
  const adapt::CertifiedLevel<2>& level = met.levels.back().level;
  EXPECT_LE(level.energy->bound, 0.02 * std::sqrt(level.norms.energy));
  EXPECT_GT(met.levels.size(), 2u);  // the residual alone would have ended it on the first
  EXPECT_EQ(met.levels.front().verdict.status, certify::RunStatus::budget);

  const Told missed = run({.degree = 2}, {.tolerance = 0.5, .bars = bars, .max_levels = 1});
  EXPECT_EQ(missed.verdict.status, certify::RunStatus::budget);
  EXPECT_NE(missed.verdict.reason.find("adapt.energy_tolerance = 2 %"), std::string::npos)
      << missed.verdict.reason;
}

/// Where no bound is possible, the demand is not met, and the run ends by its limits.
TEST(ErrorBars, ADemandWithoutABoundIsNotMet)
{
  ProblemData<2> data = pressed_block<2>();
  data.boundaries.back().contact->water = problem::Water(problem::Field(0.001));
  const adapt::ErrorBars bars{.levels = EnergyLevels::every, .energy_tolerance = 0.5};
  const Told told = run({.degree = 1}, {.tolerance = 0.9, .bars = bars, .max_levels = 1}, data);
  EXPECT_EQ(told.verdict.status, certify::RunStatus::budget);
  EXPECT_NE(told.verdict.reason.find("has no bound"), std::string::npos) << told.verdict.reason;
}

/// An interrupted run does not wait for error bars.
TEST(ErrorBars, AnInterruptedRunHasNone)
{
  const Told told = run({.degree = 2}, {.tolerance = 1e-9, .bars = {.levels = EnergyLevels::last}},
                        pressed_block<2>(), std::atomic<bool>(true));
  ASSERT_TRUE(told.levels.back().level.energy);
  EXPECT_EQ(told.levels.back().level.energy->reason, "interrupted");
}

const std::vector<problem::Quantity<2>> two_quantities{
    {.name = "e", .kind = problem::QuantityKind::energy},
    {.name = "f", .kind = problem::QuantityKind::contact_force, .boundary = "bottom"}};

/// A bound that gives up midway leaves the values of the quantities, with its reason.
TEST(ErrorBars, QuantitiesOutliveABoundThatGivesUp)
{
  mesh::Mesh<2> mesh(box<2>({0, 0}, {1, 1e-7}, {1, 1}));
  const problem::Problem<2> problem(pressed_block<2>().on(mesh));
  const adapt::Discretisation<2> flat(std::move(mesh), problem, {.degree = 2});
  std::vector<double> u(flat.space.n_dofs(), 0.0);
  for (std::size_t i = 0; i < u.size(); i += 2) u[i] = 1e-3 * flat.space.node_points()[i / 2][0];
  const certify::EnergyBound bound = adapt::energy_bound<2>(flat.form, {.degree = 2}, u, two_quantities);
  EXPECT_NE(bound.reason.find("times as long as high: mesh again"), std::string::npos) << bound.reason;
  ASSERT_EQ(bound.quantities.size(), 2u);
  for (const certify::QuantityInterval& quantity : bound.quantities) EXPECT_EQ(quantity.reason, bound.reason);
  EXPECT_EQ(bound.quantities[0].name, "e");
  EXPECT_NEAR(bound.quantities[0].value, contact::stress_norms(problem, flat.space, u).energy, 1e-20);
}

/// A mesh rejected by a limit has already taken the stress of the level that stays.
TEST(ErrorBars, ALevelWhoseSuccessorFailedHasThem)
{
  mesh::Mesh<2> mesh(block<2>({4, 2}));
  ProblemData<2> data = pressed_block<2>();
  const problem::Problem<2> problem(data.on(mesh));
  const adapt::Method method{.degree = 2, .stopping = {.finish = false}};
  std::atomic<bool> stop = false;
  adapt::Levels<2> levels(problem, method, 1e-9,
                          std::make_unique<adapt::Discretisation<2>>(std::move(mesh), problem, method),
                          &stop);
  levels.ask_for({.levels = EnergyLevels::last}, two_quantities);
  ASSERT_EQ(levels.advance(), "");
  const double bound = levels.view().level.estimate.total_sharp;
  ASSERT_EQ(levels.refine([](const adapt::LevelView<2>&) { return std::vector<Index>{0}; }), "");
  const auto leave = [&](const adapt::CertifiedStep&) { stop = true; };
  ASSERT_NE(levels.advance(leave), "");
  stop = false;
  EXPECT_TRUE(levels.bound_energy());
  ASSERT_TRUE(levels.view().level.energy);
  EXPECT_EQ(levels.view().level.energy->reason, "");
  EXPECT_EQ(levels.view().level.energy->quantities.size(), 2u);
  EXPECT_DOUBLE_EQ(levels.view().level.estimate.total_sharp, bound);
}

}  // namespace

}  // namespace tribound::test
