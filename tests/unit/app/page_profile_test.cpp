#include "app/page/page_profile.h"

#include <gtest/gtest.h>

#include "unit/app/two_blocks.h"
#include "unit/io/constant_stress.h"

namespace tribound::test
{
namespace
{

TEST(PageProfile, ValuesAlongTheFloor)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(2, 4);
  const std::vector<double> u = interpolate(box.space, constant_stress_displacement<2>);
  const std::vector<app::ContactProfile> profiles = app::contact_profiles(box.form, u, 40);
  ASSERT_EQ(profiles.size(), 1u);
  const app::ContactProfile& profile = profiles[0];
  EXPECT_EQ(box.mesh.boundary_names()[profile.tag], "bottom");
  EXPECT_TRUE(profile.damage.empty() && profile.opening.empty() && profile.water.empty());
  ASSERT_EQ(profile.arc.size(), 4u * 11);
  EXPECT_EQ(profile.arc.front(), 0.0);
  EXPECT_NEAR(profile.arc.back(), 2.0, 1e-14);
  for (std::size_t i = 0; i < profile.arc.size(); ++i)
  {
    EXPECT_GE(profile.arc[i], profile.arc[i == 0 ? 0 : i - 1] - 1e-14);
    EXPECT_NEAR(profile.points[2 * i], profile.arc[i], 1e-14);
    EXPECT_NEAR(profile.points[2 * i + 1], 0.0, 1e-14);
    EXPECT_NEAR(profile.displacement[2 * i], 0.1 * profile.arc[i], 1e-14);
    EXPECT_NEAR(profile.normal[2 * i], 0.0, 1e-14);
    EXPECT_NEAR(profile.normal[2 * i + 1], -1.0, 1e-14);
    EXPECT_NEAR(profile.pressure[i], -constant_stress<2>()[1], 1e-12);
    EXPECT_NEAR(profile.friction[i], 0.0, 1e-12);
    EXPECT_NEAR(profile.gap[i], 0.0, 1e-14);
    EXPECT_NEAR(profile.slip[i], 0.1 * profile.arc[i], 1e-14);
    EXPECT_EQ(profile.status[i], static_cast<Index>(problem::ContactStatus::slip));
  }
}

/// A bond opened by 0.3 x - 0.1, filled with water.
TEST(PageProfile, WhatAJointRemembers)
{
  ProblemData<2> data{.boundaries = {clamped<2>("left"),
                                     obstacle<2>("bottom", problem::JointLaw({.tension = {0.05, 0.003}}))}};
  data.boundaries.back().contact->water.emplace(formula("0.01*x"));
  const DiscreteProblem<2> box(block<2>({8, 4}, {1, 1, 1}), data, {.degree = 2});
  const std::vector<double> u =
      interpolate(box.space, [](const Point<2>& x) { return Point<2>(0, 0.3 * x[0] - 0.1); });
  const app::ContactProfile profile = app::contact_profiles(box.form, u, 40).at(0);
  ASSERT_EQ(profile.water.size(), profile.arc.size());
  ASSERT_EQ(profile.damage.size(), profile.arc.size());
  ASSERT_EQ(profile.opening.size(), profile.arc.size());
  for (std::size_t i = 0; i < profile.arc.size(); ++i)
  {
    SCOPED_TRACE(profile.points[2 * i]);
    EXPECT_NEAR(profile.water[i], 0.01 * profile.points[2 * i], 1e-14);
    EXPECT_EQ(profile.opening[i] > 0, profile.damage[i] > 0);
    if (profile.damage[i] < 1) continue;
    EXPECT_NEAR(profile.pressure[i], profile.water[i], 1e-12);  // nothing else acts on the broken part
    EXPECT_EQ(profile.status[i], static_cast<Index>(problem::ContactStatus::open));
  }
  EXPECT_EQ(profile.damage.front(), 0);
  EXPECT_EQ(profile.damage.back(), 1);
}

TEST(PageProfile, BothSidesBetweenBodies)
{
  const TwoBlocks<2> blocks(1, 3);
  const auto displacement = [](const Point<2>& x)
  { return x[1] < -0.05 ? Point<2>(0.1 * x[0], 0.2) : Point<2>(0.3, 0.4 * x[0]); };
  const app::ContactProfile profile =
      app::contact_profiles(blocks.form, interpolate(blocks.space, displacement), 40)[0];
  ASSERT_EQ(profile.opposite.size(), profile.points.size());
  for (std::size_t i = 0; i < profile.arc.size(); ++i)
  {
    const double x = profile.points[2 * i];
    EXPECT_EQ(profile.bodies[i], 0);
    EXPECT_EQ(profile.opposite_bodies[i], 1);
    EXPECT_NEAR(profile.opposite[2 * i], x, 1e-13);
    EXPECT_NEAR(profile.opposite[2 * i + 1], -TwoBlocks<2>::distance, 1e-13);
    EXPECT_NEAR(profile.opposite_displacement[2 * i], 0.1 * x, 1e-13);
    EXPECT_NEAR(profile.opposite_displacement[2 * i + 1], 0.2, 1e-13);
  }
}

TEST(PageProfile, FewPointsPerFacetOnLongBoundaries)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(2, 4);
  const std::vector<double> u = interpolate(box.space, constant_stress_displacement<2>);
  EXPECT_EQ(app::contact_profiles(box.form, u, 1)[0].arc.size(), 4u * 3);
}

}  // namespace
}  // namespace tribound::test
