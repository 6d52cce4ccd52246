/// @file history_check_test.cpp
/// Load paths repeated with half the steps on a finer mesh, against the same path followed by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "support/bonded_path.h"
#include "support/snap_back_bar.h"
#include "tribound/adapt/history_check.h"
#include "tribound/io/record/history_check.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test::history_check_cases
{
namespace
{

struct Followed
{
  adapt::PathEnd end;
  std::vector<double> t;
  std::optional<io::LoadStepRecord> last;
  std::vector<certify::RunStatus> status;
  std::vector<double> bounds;
  std::int64_t n_cells = 0;

  template <int dim>
  void add(const adapt::LoadStep<dim>& step)
  {
    t.push_back(step.t);
    status.push_back(step.verdict.status);
    bounds.push_back(step.level.estimate.total);
    n_cells = step.at->discrete.mesh.n_global_cells();
    last = io::load_step_record<dim>(step, last ? &*last : nullptr);
  }
};

/// A path, and the result of follow_finely() on it.
template <int dim>
struct Case
{
  mesh::MeshData<dim> mesh;
  problem::Problem<dim> problem;
  adapt::Method method{};
  adapt::PathProgram program{};

  [[nodiscard]] Followed follow(mesh::Mesh<dim> on, const adapt::PathProgram& steps) const
  {
    adapt::LoadPath<dim> path(problem, method, {}, std::move(on));
    Followed result;
    result.end =
        adapt::follow<dim>(path, steps, [&](const adapt::LoadStep<dim>& step) { result.add<dim>(step); }, {});
    return result;
  }
  [[nodiscard]] Followed follow() const { return follow(mesh::Mesh<dim>(mesh), program); }
  [[nodiscard]] Followed check(const std::atomic<bool>* stop = nullptr) const
  {
    const adapt::Grid<dim> grid(mesh::Mesh<dim>(mesh), method.degree);
    Followed result;
    const adapt::ReplayObserver<dim> observer{.step = [&](const adapt::LoadStep<dim>& step)
                                              { result.add<dim>(step); }};
    result.end = adapt::follow_finely<dim>(grid, problem, method, program, observer, stop);
    return result;
  }
};

template <int dim>
Case<dim> peeled_case(const problem::ContactLaw& law, bool pairs, int degree)
{
  mesh::MeshData<dim> mesh = peeled_mesh<dim>(pairs);
  Case<dim> made{mesh, peeled<dim>(law, pairs).on(mesh::Mesh<dim>(mesh))};
  made.method.degree = degree;
  made.method.newton.tolerance = 1e-12;
  made.method.stopping.criterion = adapt::Stopping::last_bounded;
  return made;
}

template <int dim>
mesh::Mesh<dim> bisected(const mesh::MeshData<dim>& data)
{
  const mesh::Mesh<dim> mesh{mesh::MeshData<dim>(data)};
  return std::move(mesh::bisect<dim>(mesh, adapt::mark_all(mesh.n_cells())).mesh);
}

TEST(HistoryCheck, HalvesEveryStep)
{
  const adapt::PathProgram program =
      adapt::with_half_the_steps({.targets = {0, 40, 30, 30},
                                  .following = adapt::Following::damage,
                                  .damage_step = 3.0,
                                  .displacement = {.step = 0.5, .until = 7},
                                  .max_steps = 8,
                                  .then = adapt::DisplacementStage{.step = -1e-3, .until = -1}});
  EXPECT_THAT(program.targets, testing::ElementsAre(0, 20, 40, 35, 30, 30, 30));
  EXPECT_EQ(program.following, adapt::Following::damage);
  EXPECT_EQ(program.damage_step, 1.5);
  EXPECT_EQ(program.damage_steps, 100);
  EXPECT_EQ(program.displacement.step, 0.25);
  EXPECT_EQ(program.displacement.until, 7);
  EXPECT_EQ(program.max_steps, 16);
  EXPECT_EQ(program.then.value().step, -5e-4);
  EXPECT_EQ(program.then->until, -1);
  EXPECT_FALSE(adapt::with_half_the_steps({.targets = {1}}).damage_step);
}

template <int dim>
void expect_the_path_by_hand(const problem::ContactLaw& law, bool pairs, int degree)
{
  SCOPED_TRACE(problem::words(law));
  Case<dim> of = peeled_case<dim>(law, pairs, degree);
  of.program.targets = {0.5, 1.1, 0.4};
  const Followed check = of.check();
  ASSERT_EQ(check.end.failure, "");
  EXPECT_THAT(check.status, testing::Each(certify::RunStatus::uncertified));
  EXPECT_THAT(check.bounds, testing::Each(0));
  const Followed by_hand = of.follow(bisected(of.mesh), {.targets = {0.5, 0.8, 1.1, 0.75, 0.4}});
  ASSERT_EQ(by_hand.end.failure, "");
  EXPECT_EQ(check.t, by_hand.t);
  EXPECT_EQ(check.n_cells, static_cast<std::int64_t>(of.mesh.cells.size()) << dim);
  EXPECT_GT(by_hand.last->work, 1e-5);
  EXPECT_NEAR(check.last->effective_normal, by_hand.last->effective_normal, 1e-9);
  EXPECT_NEAR(check.last->tangential, by_hand.last->tangential, 1e-9);
  EXPECT_NEAR(check.last->dissipated, by_hand.last->dissipated, 1e-10);
  EXPECT_NEAR(check.last->work, by_hand.last->work, 1e-10);
}

TEST(HistoryCheck, IsThePathByHandWithoutItsBounds)
{
  for (const problem::ContactLaw& law : bonded_laws())
    for (const bool pairs : {false, true}) expect_the_path_by_hand<2>(law, pairs, 2);
  expect_the_path_by_hand<3>(bonded_laws()[1], true, 1);
  expect_the_path_by_hand<3>(bonded_laws()[3], false, 1);
}

/// No softening, and loads that only grow: the errors of the steps add up to little.
TEST(HistoryCheck, DiffersLittleWhereNothingSoftens)
{
  Case<2> of = peeled_case<2>(problem::JointLaw({.coefficient = 0.3}, 0.01), false, 2);
  ProblemData<2> data = peeled<2>(problem::JointLaw({.coefficient = 0.3}, 0.01), false);
  data.boundaries[1] = problem::with_traction<2>("top", {formula("0.02*t"), -0.1});
  data.boundaries[2] = problem::with_traction<2>("right", {formula("0.05*t"), 0.0});
  of.problem = data.on(mesh::Mesh<2>(of.mesh));
  of.program.targets = {0.5, 1, 1.5};
  const Followed path = of.follow();
  const Followed check = of.check();
  const std::vector<io::ComparedFigure> figures =
      io::compare(path.end, *path.last, {.steps = 5, .last = check.last, .end = check.end});
  ASSERT_EQ(figures.size(), 5U);
  EXPECT_EQ(check.t, (std::vector<double>{0.5, 0.75, 1, 1.25, 1.5}));
  EXPECT_FALSE(figures[0].difference());  // no peak
  EXPECT_EQ(figures[1].difference(), 0);  // of t
  for (std::size_t i = 2; i < 5; ++i)
  {
    SCOPED_TRACE(figures[i].name);
    EXPECT_GT(std::abs(figures[i].path.value()), 1e-5);
    EXPECT_NE(figures[i].difference(), 0);
    EXPECT_LE(std::abs(figures[i].difference().value()), 0.02 * std::abs(*figures[i].path));
  }
}

/// Water acts on the body in place of contact: the effective resultant contains both.
TEST(HistoryCheck, KnowsEffectiveForces)
{
  mesh::MeshData<2> mesh = peeled_mesh<2>(false);
  Case<2> of{mesh, peeled_under_water<2>(bonded_laws()[0], false).on(mesh::Mesh<2>(mesh))};
  of.method.stopping.criterion = adapt::Stopping::last_bounded;
  of.program.targets = {0.5, 1.1};
  const io::LoadStepRecord last = of.follow().last.value();
  EXPECT_GT(last.all.hydraulic.value().uplift, 1e-4);
  EXPECT_NEAR(last.effective_normal, last.all.hydraulic->effective_normal, 1e-10);
}

TEST(HistoryCheck, PeakOfABarIsThatOfTwoPathsByHand)
{
  const Bar<2> bar(2);
  Case<2> of{bar.mesh,
             bar.problem,
             bar.method,
             {.targets = {0.0009, 0.0017}, .following = adapt::Following::damage, .damage_step = 0.4}};
  const Followed path = of.follow();
  const Followed check = of.check();
  const Followed by_hand = of.follow(
      bisected(bar.mesh),
      {.targets = {0.0009, 0.0013, 0.0017}, .following = adapt::Following::damage, .damage_step = 0.2});
  ASSERT_EQ(check.end.failure, "");
  ASSERT_EQ(by_hand.end.failure, "");
  EXPECT_EQ(check.t.size(), by_hand.t.size());
  EXPECT_GT(check.t.size(), path.t.size());
  const std::vector<io::ComparedFigure> figures =
      io::compare(path.end, *path.last, {.last = check.last, .end = check.end});
  ASSERT_EQ(figures.size(), 5U);
  EXPECT_STREQ(figures[0].name, "peak_t");
  EXPECT_NEAR(figures[0].difference().value(), by_hand.end.peak.value().t - path.end.peak.value().t, 1e-12);
  EXPECT_STREQ(figures[4].name, "dissipated");
  EXPECT_NEAR(figures[4].difference().value(), by_hand.last->dissipated - path.last->dissipated, 1e-12);
  // Both end with 99 % of the bond broken: the energy of breaking it, over a length of 2.
  EXPECT_NEAR(*figures[4].check, 0.99 * 2 * snap_back::Gc, 1e-9);
  EXPECT_NEAR(figures[4].difference().value(), 0, 1e-9);
}

TEST(HistoryCheck, SaysWhyThereIsNone)
{
  Case<2> of = peeled_case<2>(Coulomb(0.3), false, 1);
  of.program.targets = {0, 1};
  ProblemData<2> data = peeled<2>(Coulomb(0.3), false);
  data.boundaries[2] = problem::with_traction<2>("right", {formula("-1e-3*sqrt((t - 0.5)^2 - 0.1)"), 0.0});
  of.problem = data.on(mesh::Mesh<2>(of.mesh));
  EXPECT_EQ(of.follow().end.failure, "");
  const Followed check = of.check();
  EXPECT_THAT(check.end.failure, testing::HasSubstr("is undefined (nan)"));
  EXPECT_EQ(check.t, std::vector<double>{0});
  EXPECT_TRUE(io::compare({}, *check.last, {.last = check.last, .end = check.end}).empty());

  const std::atomic<bool> stop = true;
  EXPECT_THAT(peeled_case<2>(Coulomb(0.3), false, 1).check(&stop).end.failure, testing::Eq(""));
  of = peeled_case<2>(Coulomb(0.3), false, 1);
  of.program.targets = {0.5, 1};
  EXPECT_THAT(of.check(&stop).end.failure, testing::HasSubstr("interrupted at t = 0.5"));
}

}  // namespace
}  // namespace tribound::test::history_check_cases
