/// @file path_program_test.cpp
/// Load paths beyond their peak: snap-back of bars against the closed formula, peaks, stages, and paths that
/// cannot be followed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/snap_back_bar.h"
#include "tribound/adapt/path_program.h"
#include "tribound/adapt/process_zone.h"

namespace tribound::test
{
namespace
{

using snap_back::critical;
using snap_back::ft;
using snap_back::Gc;

struct Followed
{
  adapt::PathEnd end;
  std::vector<double> t;
  std::vector<std::string> control;
  std::size_t most_newton_steps = 0;
};

/// Every step has the exact traction, sigma = ft (1 - delta / delta_c) and t = sigma / M + delta.
template <int dim>
Followed follow_exactly(const Bar<dim>& bar, const adapt::PathProgram& program,
                        const adapt::PathOptions& options = {})
{
  const double M = Bar<dim>::material().lambda + 2 * Bar<dim>::material().mu;
  adapt::LoadPath<dim> path(bar.problem, bar.method, options, mesh::Mesh<dim>(bar.mesh));
  Followed result;
  const auto check = [&](const adapt::LoadStep<dim>& step)
  {
    SCOPED_TRACE(step.t);
    EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified) << step.verdict.reason;
    EXPECT_LE(step.level.estimate.total, 1e-8);
    result.t.push_back(step.t);
    result.control.push_back(step.control);
    result.most_newton_steps = std::max(result.most_newton_steps, step.level.steps.size());
    for (const problem::InterfaceResponse<dim>& response : step.responses)
    {
      const double damage = response.state.damage;
      const double pulled = damage < 1 ? M * (step.t - damage * critical) : 0;
      EXPECT_NEAR(-response.traction[1], pulled, 1e-9);  // n = (0, -1)
      if (damage > 0)
      {
        EXPECT_NEAR(-response.traction[1], ft * (1 - damage), 1e-9);
      }
    }
  };
  result.end = adapt::follow<dim>(path, program, check, {});
  return result;
}

template <int dim>
void expect_a_snap_back(const Followed& followed, const std::string& control)
{
  EXPECT_EQ(followed.end.failure, "");
  const double M = Bar<dim>::material().lambda + 2 * Bar<dim>::material().mu;
  ASSERT_TRUE(followed.end.peak);
  EXPECT_NEAR(followed.end.peak->t, ft / M, 0.2 * ft / M);
  EXPECT_LE(followed.end.peak->t, ft / M * (1 + 1e-9));
  EXPECT_LT(followed.t.back(), critical * 1.1);
  EXPECT_EQ(followed.control.back(), control);
  EXPECT_LE(followed.most_newton_steps, 6U);
}

TEST(PathProgram, BarThroughItsSnapBackByDamage)
{
  for (const int degree : {1, 2})
  {
    // The peak of the path lies between two steps of the list; damage control takes over where Newton's
    // method fails.
    const Followed automatic = follow_exactly(
        Bar<2>(degree),
        {.targets = {0.0009, 0.0016, 0.0025}, .following = adapt::Following::automatic, .damage_step = 0.2});
    expect_a_snap_back<2>(automatic, "damage");
    EXPECT_THAT(automatic.end.dropped, testing::ElementsAre(0.0025));
  }
  expect_a_snap_back<3>(follow_exactly(Bar<3>(1), {.targets = {0.0009, 0.0017},
                                                   .following = adapt::Following::damage,
                                                   .damage_step = 0.2}),
                        "damage");
}

TEST(PathProgram, BarThroughItsSnapBackByOpening)
{
  const adapt::Gauge opening{.boundary = "bottom"};
  const adapt::Gauge top{.boundary = "top", .component = 1, .factor = 0.1};
  // The opening alone is zero before the bond softens.
  const adapt::PathProgram program{.targets = {0.0009, 0.0017},
                                   .following = adapt::Following::displacement,
                                   .displacement = {.gauges = {opening, top}, .step = 5e-5, .until = 6.5e-4}};
  for (const int degree : {1, 2, 3})
    expect_a_snap_back<2>(follow_exactly(Bar<2>(degree), program), "displacement");
}

TEST(PathProgram, EveryLawWithABondIsFollowed)
{
  for (const problem::ContactLaw& law :
       {problem::ContactLaw(problem::JointLaw({.tension = {ft, Gc, problem::Unloading::vertical}})),
        problem::ContactLaw(problem::MixedLaw({.tension = {ft, Gc}, .shear_ratio = 0.8}))})
    expect_a_snap_back<2>(follow_exactly(Bar<2>(2, law), {.targets = {0.0009, 0.0017, 0.003},
                                                          .following = adapt::Following::automatic,
                                                          .damage_step = 0.3}),
                          "damage");
}

/// After the bond is broken the bar lifts off: a rigid motion except for what holds it.
TEST(PathProgram, GoesOnByADisplacement)
{
  const Followed followed = follow_exactly(
      Bar<2>(2), {.targets = {0.0009, 0.0017, 0.003},
                  .following = adapt::Following::automatic,
                  .damage_step = 0.3,
                  .enough_damage = 1,
                  .then = adapt::DisplacementStage{
                      .gauges = {{.boundary = "top", .component = 1}}, .step = 2e-4, .until = 1.2e-3}});
  EXPECT_EQ(followed.end.failure, "");
  EXPECT_THAT(followed.control, testing::Contains("damage"));
  EXPECT_EQ(followed.control.back(), "displacement");
  EXPECT_NEAR(followed.t.back(), 1.2e-3, 1e-12);
}

TEST(PathProgram, EndsAtStops)
{
  adapt::PathProgram program{
      .targets = {0.0009, 0.0017}, .following = adapt::Following::damage, .damage_step = 0.1, .max_steps = 3};
  EXPECT_EQ(follow_exactly(Bar<2>(1), program).t.size(), 5U);
  program.max_steps = 100;
  program.t_min = 0.0015;
  const Followed followed = follow_exactly(Bar<2>(1), program);
  EXPECT_LE(followed.t.back(), 0.0015);
  EXPECT_GT(followed.t.at(followed.t.size() - 2), 0.0015);
}

TEST(PathProgram, PeakOfHalvedSteps)
{
  const Followed followed = follow_exactly(
      Bar<2>(2), {.targets = {0.0009, 0.0017}, .following = adapt::Following::damage, .damage_step = 0.4});
  const double exact = ft / (Bar<2>::material().lambda + 2 * Bar<2>::material().mu);
  const auto highest = std::ranges::max_element(followed.t);
  ASSERT_TRUE(followed.end.peak);
  EXPECT_EQ(followed.end.peak->number, highest - followed.t.begin() + 1);
  EXPECT_GE(followed.end.peak->t, *highest);
  EXPECT_NEAR(followed.end.peak->t, exact, 0.002 * exact);
  EXPECT_LE(std::abs(followed.end.peak->change.value()), 1e-3 * exact);
}

/// Displacement and water pressure that are not affine in t. With d(t) the displacement of the top and
/// delta = D delta_c: sigma = ft (1 - D) - p_w(t) and d(t) = sigma / M + delta.
TEST(PathProgram, DataNeedNotBeAffineInT)
{
  ProblemData<2> data = Bar<2>::data(problem::JointLaw({.tension = {ft, Gc}}));
  data.boundaries[0] = problem::with_displacement<2>("top", {std::nullopt, formula("t + 100*t^2")});
  data.boundaries[1].contact->water.emplace(formula("2e5*t^2"));
  const Bar<2> bar(2);
  const problem::Problem<2> problem = data.on(mesh::Mesh<2>(bar.mesh));
  const double M = Bar<2>::material().lambda + 2 * Bar<2>::material().mu;
  adapt::LoadPath<2> path(problem, bar.method, {}, mesh::Mesh<2>(bar.mesh));
  std::vector<double> t;
  const auto check = [&](const adapt::LoadStep<2>& step)
  {
    SCOPED_TRACE(step.t);
    EXPECT_NE(step.verdict.status, certify::RunStatus::not_certified) << step.verdict.reason;
    EXPECT_LE(step.level.steps.size(), 7U);
    t.push_back(step.t);
    const double top = step.t + 100 * step.t * step.t;
    const double water = 2e5 * step.t * step.t;
    for (const problem::InterfaceResponse<2>& response : step.responses)
    {
      const double damage = response.state.damage;
      EXPECT_NEAR(-response.traction[1], M * (top - damage * critical), 1e-9);
      if (damage > 0)
      {
        EXPECT_NEAR(-response.traction[1], ft * (1 - damage) - water, 1e-9);
      }
    }
  };
  const adapt::PathEnd end = adapt::follow<2>(path,
                                              {.targets = {0.0007, 0.0012},
                                               .following = adapt::Following::damage,
                                               .damage_step = 0.2,
                                               .enough_damage = 0.9},
                                              check, {});
  EXPECT_EQ(end.failure, "");
  EXPECT_NEAR(end.peak.value().t, 0.0013155, 2e-6);  // M d + p_w = ft
  EXPECT_GT(t.size(), 8U);
  EXPECT_LT(t.back(), 0.001);
}

/// The bond softens along its closed formula whether its damage or its opening is controlled.
TEST(ProcessZone, LeadsOnInPlaceOfTheDamage)
{
  const Bar<2> bar(2);
  const double M = Bar<2>::material().lambda + 2 * Bar<2>::material().mu;
  adapt::LoadPath<2> path(bar.problem, bar.method, {}, mesh::Mesh<2>(bar.mesh));
  for (const double t : {0.0009, 0.0017}) ASSERT_EQ(path.advance(t), "");
  const adapt::PathMeasure<2> damage;
  const adapt::Control<2> control{
      .name = "damage", .measure = damage, .increment = 0.2, .last_increment = 0.2, .largest_change = 0.01};
  EXPECT_FALSE(adapt::follow_zone(path, control, {}, {}));  // nothing is damaged yet
  ASSERT_EQ(path.follow(control), "");

  const adapt::LoadStep<2> last = *path.last();
  const contact::NitscheForm<2>& form = last.at->discrete.form;
  const std::vector<double> before = path.position().before_last.u;
  const auto zone = adapt::zone_measure<2>(form, last.responses, before, last.level.u);
  ASSERT_TRUE(zone);
  EXPECT_NEAR(zone->value(form, last.level.u) - zone->value(form, before), 1, 1e-12);

  ASSERT_TRUE(adapt::follow_zone(path, control, {}, {}));
  EXPECT_EQ(path.last()->control, "zone");
  EXPECT_EQ(adapt::moving_share(*path.last()), 1);
  EXPECT_LT(path.last()->t, last.t);
  for (const problem::InterfaceResponse<2>& response : path.last()->responses)
  {
    EXPECT_NEAR(response.state.damage, 0.2, 0.05);  // 0.1 in each step, over a length of 2
    EXPECT_NEAR(path.last()->t, ft * (1 - response.state.damage) / M + response.state.damage * critical,
                1e-10);
  }
}

TEST(PathProgram, WhatCannotBeFollowedIsSaid)
{
  const Followed load = follow_exactly(Bar<2>(1), {.targets = {0.0009, 0.0017, 0.0019}}, {.smallest = 0.1});
  EXPECT_THAT(load.end.failure, testing::HasSubstr("load step"));
  const Followed early =
      follow_exactly(Bar<2>(1), {.targets = {0.0009, 0.0019}, .following = adapt::Following::automatic});
  EXPECT_THAT(early.end.failure, testing::HasSubstr("takes two load steps before"));
}

}  // namespace
}  // namespace tribound::test
