/// @file solution_facts_test.cpp
/// Penetration, sliding and zigzags of given displacements. With E = 1 and nu = 0, a displacement (0, w(x))
/// that is constant in y has sigma^n = 0 at the bottom, so the pressure there is gamma (-w - g)_+.

#include "tribound/doctor/solution_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

using ::testing::SizeIs;

/// gamma = 1/h.
template <int dim>
DiscreteProblem<dim> on_obstacle(mesh::MeshData<dim> mesh, const problem::BoundaryCondition<dim>& contact)
{
  return {std::move(mesh), {.boundaries = {contact}, .material = lame(1, 0)}, {.degree = 1, .gamma0 = 1}};
}

/// Eight facets of length 1/4 at the bottom: gamma = 4.
doctor::ContactOutcome outcome(const problem::Contact& contact,
                               const std::function<Point<2>(const Point<2>&)>& u)
{
  const DiscreteProblem<2> c = on_obstacle<2>(block<2>({8, 4}), obstacle<2>("bottom", contact));
  const auto outcomes = doctor::contact_outcomes<2>(c.form, interpolate<2>(c.space, u));
  EXPECT_THAT(outcomes, SizeIs(1));
  return outcomes.front();
}

TEST(SolutionFacts, Penetration)
{
  const doctor::ContactOutcome found = outcome(problem::Contact(Frictionless(), 0.25),
                                               [](const Point<2>& x) -> Point<2> {
                                                 return {0, -0.25 * x[0]};
                                               });
  EXPECT_EQ(found.boundary, "bottom");
  EXPECT_EQ(found.facets, 8);
  EXPECT_EQ(found.closed_facets, 4);  // u^n = x/4 passes the gap at x = 1
  EXPECT_NEAR(found.closed, 1, 1e-12);
  EXPECT_NEAR(found.penetration, 0.25 * found.penetration_at[0] - 0.25, 1e-14);
  EXPECT_NEAR(found.penetration_at[0], 2, 0.02);
  EXPECT_NEAR(found.largest_pressure, 4 * found.penetration, 1e-13);
  EXPECT_FALSE(found.has_friction);
  EXPECT_FALSE(found.coefficient);
}

TEST(SolutionFacts, OpenContact)
{
  const doctor::ContactOutcome found = outcome(problem::Contact(Frictionless()),
                                               [](const Point<2>&) -> Point<2> {
                                                 return {0, 1};
                                               });
  EXPECT_EQ(found.closed, 0);
  EXPECT_EQ(found.closed_facets, 0);
  EXPECT_EQ(found.penetration, 0);
  EXPECT_TRUE(found.penetration_at.empty());
}

/// Softens from an opening of 0, is broken from an opening of 1, and does not slip.
const problem::Contact bond(problem::JointLaw({.tension = {.strength = 1, .fracture_energy = 0.5},
                                               .stick = true}));

/// u^n = -slope x: with gamma = 4 the resolvent opens where 4 slope x > 1 and breaks where it reaches 4.
doctor::DamageFacts damage_of_opening(double slope)
{
  return outcome(bond,
                 [&](const Point<2>& x) -> Point<2> {
                   return {0, slope * x[0]};
                 })
      .damage;
}

TEST(SolutionFacts, ProcessZone)
{
  EXPECT_FALSE(damage_of_opening(0.4).process_zone);  // nothing is broken
  const std::optional<double> wide = damage_of_opening(0.75).process_zone;
  ASSERT_TRUE(wide);
  EXPECT_NEAR(*wide, 4, 0.5);  // from x = 1/3 to 4/3: four facets of 1/4, judging by the points
  const std::optional<double> narrow = damage_of_opening(3).process_zone;
  ASSERT_TRUE(narrow);
  EXPECT_NEAR(*narrow, 1, 0.3);
}

TEST(SolutionFacts, ProcessZoneIn3D)
{
  const DiscreteProblem<3> c = on_obstacle<3>(block<3>({8, 2, 4}), obstacle<3>("bottom", bond));
  const auto outcomes = doctor::contact_outcomes<3>(c.form, interpolate<3>(c.space,
                                                                           [](const Point<3>& x) -> Point<3> {
                                                                             return {0, 0.8 * x[0], 0};
                                                                           }));
  ASSERT_THAT(outcomes, SizeIs(1));
  ASSERT_TRUE(outcomes[0].damage.process_zone);
  const double softens_from = 0.25 * std::sqrt(2) / 0.8;  // gamma = 1/h, h the diameter of a facet
  EXPECT_NEAR(*outcomes[0].damage.process_zone, (1 / 0.8 - softens_from) / 0.25, 0.3);
}

TEST(SolutionFacts, SofteningMargin)
{
  const doctor::Softening found = damage_of_opening(0).softening;
  EXPECT_DOUBLE_EQ(found.slope, 1);
  EXPECT_DOUBLE_EQ(found.gamma, 4);
  EXPECT_DOUBLE_EQ(found.h, 0.25);
  EXPECT_EQ(outcome(problem::Contact(Frictionless()),
                    [](const Point<2>&) -> Point<2> {
                      return {0, 0};
                    })
                .damage.softening.ratio(),
            0);
}

TEST(SolutionFacts, CohesionThatOpeningDoesNotBreak)
{
  const auto open_cohesion = [](const problem::Joint& joint)
  {
    return outcome(problem::Contact(problem::JointLaw(joint)),
                   [](const Point<2>&) -> Point<2> {
                     return {0, 0};
                   })
        .damage.open_cohesion;
  };
  EXPECT_EQ(open_cohesion({.cohesion = 0.7}), 0.7);
  EXPECT_EQ(open_cohesion({.cohesion = 0.7, .slip_length = 2}), 0.7);
  EXPECT_EQ(open_cohesion({.tension = {1, 1}, .cohesion = 0.7}), 0);
  EXPECT_EQ(open_cohesion({.coefficient = 0.5}), 0);
}

TEST(SolutionFacts, SlidingAndSticking)
{
  const problem::Contact coulomb(Coulomb(0.5));
  const doctor::ContactOutcome slides = outcome(coulomb,
                                                [](const Point<2>&) -> Point<2> {
                                                  return {0.25, -0.25};
                                                });
  EXPECT_TRUE(slides.has_friction);
  EXPECT_EQ(slides.coefficient, 0.5);
  EXPECT_NEAR(slides.slipping, 2, 1e-12);
  const doctor::ContactOutcome sticks = outcome(coulomb,
                                                [](const Point<2>&) -> Point<2> {
                                                  return {0, -0.25};
                                                });
  EXPECT_EQ(sticks.slipping, 0);
  EXPECT_NEAR(sticks.closed, 2, 1e-12);
}

TEST(SolutionFacts, ForceAndMeanPressure)
{
  const doctor::ContactOutcome found = outcome(problem::Contact(Frictionless(), 0.25),
                                               [](const Point<2>& x) -> Point<2> {
                                                 return {0, -0.25 * x[0]};
                                               });
  EXPECT_NEAR(found.force, 4 * 0.25 / 2, 1e-12);  // 4 (x/4 - 1/4) from 1 to 2
  EXPECT_NEAR(found.mean_pressure(), 0.5, 1e-12);
}

/// Steep, curved or kinked, but none oscillates.
TEST(SolutionFacts, PressuresWithoutZigzag)
{
  const std::vector<std::function<double(double)>> pressures = {
      [](double x) { return 0.25 + 0.1 * x; }, [](double x) { return 1 - 0.1 * x * x; },
      [](double x) { return std::exp(-5 * x); }, [](double x) { return 1 + 3 * std::abs(x - 1); },
      [](double x) { return std::sqrt(2.01 - x); }};
  for (const auto& p : pressures)
    EXPECT_NEAR(outcome(problem::Contact(Frictionless()),
                        [&](const Point<2>& x) -> Point<2> {
                          return {0, -p(x[0])};
                        })
                    .zigzag,
                0, 1e-13);
}

/// A gap that jumps by 2 a from facet to facet: mean pressures gamma (1 - a +- a). They zigzag by gamma a on
/// the four facets whose neighbours have two neighbours.
TEST(SolutionFacts, ZigzagOfTheGap)
{
  const problem::Contact jumping(Frictionless(), formula("0.01 + 0.01*(sin(4*pi*x) > 0 ? 1 : -1)"));
  const doctor::ContactOutcome found = outcome(jumping,
                                               [](const Point<2>&) -> Point<2> {
                                                 return {0, -1};
                                               });
  EXPECT_NEAR(found.zigzag, 0.01 * std::sqrt(0.5) / std::hypot(0.99, 0.01), 1e-12);
  EXPECT_NEAR(found.largest_pressure, 4, 1e-12);
}

/// The bottom bent to a polygon of three facets; pressed in by 1, and by 1 more near the end.
TEST(SolutionFacts, PressureAtKinks)
{
  const auto bend = [](const Point<2>& x) -> Point<2> {
    return {x[0], x[1] + 0.01 * x[0] * x[0]};
  };
  const DiscreteProblem<2> c =
      on_obstacle<2>(mapped<2>(box<2>({0, 0}, {3, 1}, {3, 1}), bend), obstacle<2>("bottom"));
  const auto press = [&](const std::function<double(double)>& w)
  {
    return doctor::contact_outcomes<2>(c.form, interpolate<2>(c.space,
                                                              [&](const Point<2>& x) -> Point<2> {
                                                                return {0, -w(x[0])};
                                                              }))
        .front();
  };
  const doctor::ContactOutcome even = press([](double) { return 1; });
  EXPECT_NEAR(even.kink, (std::atan(0.05) - std::atan(0.03)) * 180 / std::numbers::pi, 0.02);
  EXPECT_NEAR(even.kink_pressure / even.mean_pressure(), 1, 0.05);
  const doctor::ContactOutcome peaked = press([](double x) { return x > 2.5 ? 10 : 1; });
  EXPECT_GT(peaked.kink_pressure / peaked.mean_pressure(), 2);
  EXPECT_NEAR(peaked.kink_at[0], 3, 0.1);
  EXPECT_EQ(press([](double) { return -1; }).kink, 0);  // nothing touches
}

TEST(SolutionFacts, ZigzagIn3D)
{
  const DiscreteProblem<3> c = on_obstacle<3>(box<3>({0, 0, 0}, {1, 1, 1}, {4, 4, 1}), obstacle<3>("back"));
  const auto zigzag = [&](const std::function<double(const Point<3>&)>& w)
  {
    return doctor::contact_outcomes<3>(c.form, interpolate<3>(c.space,
                                                              [&](const Point<3>& x) -> Point<3> {
                                                                return {0, 0, -w(x)};
                                                              }))
        .front()
        .zigzag;
  };
  EXPECT_NEAR(zigzag([](const Point<3>& x) { return 1 + 0.1 * x[0] - 0.2 * x[1]; }), 0, 1e-12);
  const double rough =
      zigzag([](const Point<3>& x) { return 1 + 0.1 * std::cos(4 * std::numbers::pi * x[0]); });
  EXPECT_GT(rough, 0.01);  // means of +-0.1/3, and facets at the edges do not count
}

}  // namespace

}  // namespace tribound::test
