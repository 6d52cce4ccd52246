/// @file rigid_motion_contact_test.cpp
/// What contact can hold with every law, by geometry and by friction.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "unit/contact/rigid_motion_testing.h"

namespace tribound::test
{

namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(RigidMotion, FrictionlessFloorLeavesTheMotionAlongIt)
{
  const auto on_floor = [](const mesh::MeshData<2>& mesh, const problem::ContactLaw& law) {
    return verdict<2>(mesh, {loaded<2>("top", 0, -1), obstacle<2>("bottom", law)});
  };
  const std::string said = on_floor(block(), Frictionless());
  EXPECT_THAT(said, AllOf(HasSubstr("from: translation along x\n"), HasSubstr("or give its contact")));
  EXPECT_EQ(on_floor(block(), Coulomb(0)), said);
  EXPECT_EQ(on_floor(block(), Tresca(0)), said);
  EXPECT_THAT(on_floor(on_slope(0.5), Frictionless()),
              HasSubstr("from: translation along (0.8776, 0.4794)\n"));
}

TEST(RigidMotion, BlockOnFloorWithFrictionIsHeld)
{
  EXPECT_EQ(verdict<2>(block(), {loaded<2>("top", 0, -1), obstacle<2>("bottom", Coulomb(0.2))}), "held");
  EXPECT_EQ(verdict<3>(brick(), {loaded<3>("top", 0.1, -1, 0.1), obstacle<3>("bottom", Coulomb(0.2))}),
            "held");
}

TEST(RigidMotion, BalancedOrAbsentLoadsNeedNoContactForce)
{
  const auto floor = obstacle<2>("bottom", Coulomb(0.2));
  EXPECT_EQ(verdict<2>(block(), {floor}), "held");
  EXPECT_EQ(verdict<2>(block(), {floor, loaded<2>("left", -0.3, 0), loaded<2>("right", 0.3, 0)}), "held");
}

TEST(RigidMotion, BlockPulledOffTheFloor)
{
  const std::string said = verdict<2>(block(), {loaded<2>("top", 0, 1), obstacle<2>("bottom", Coulomb(0.2))});
  EXPECT_THAT(said, HasSubstr("boundary.bottom: contact cannot hold the body (region \"box\"): the loads "
                              "drive it into translation along y; contact only pushes"));
  EXPECT_THAT(verdict<3>(brick(), {loaded<3>("top", 0, 1), obstacle<3>("bottom", Tresca(9))}),
              HasSubstr("drive it into translation along y"));
}

TEST(RigidMotion, BlockTippedOverItsEdge)
{
  // 2 downwards in the middle of [0, 2], and upwards at the right end: the resultant acts left of the block
  const std::string said = verdict<2>(
      block(), {loaded<2>("top", 0, -1), loaded<2>("right", 0, 1.5), obstacle<2>("bottom", Coulomb(5))});
  EXPECT_THAT(said, HasSubstr("drive it into rotation about (0, 0)"));
}

TEST(RigidMotion, BlockPushedHighTipsBeforeItSlides)
{
  // A side load on top of a block of weight 2, width 2 and height 1 tips it from 2 on and makes it slide from
  // 4 on.
  const auto pushed = [](double load) {
    return verdict<2>(block(), {loaded<2>("top", load, 0), obstacle<2>("bottom", Coulomb(2))}, {0, -1});
  };
  EXPECT_EQ(pushed(0.999), "held");
  EXPECT_THAT(pushed(1.001), HasSubstr("drive it into rotation about (2, 0); contact only pushes"));
}

TEST(RigidMotion, CoulombHoldsUpToTheFrictionAngle)
{
  const double angle = 0.3;
  const auto slope = [&](double coefficient) {
    return verdict<2>(on_slope(angle), {obstacle<2>("bottom", Coulomb(coefficient))}, {0, -1});
  };
  EXPECT_EQ(slope(std::tan(angle) * 1.001), "held");
  EXPECT_THAT(slope(std::tan(angle) * 0.999),
              HasSubstr("drive it into translation along (-0.9553, -0.2955); friction is too weak"));
}

TEST(RigidMotion, CoulombConeIn3DIsRound)
{
  const auto slope = [](double angle, double coefficient) {
    return verdict<3>(brick_on_slope(angle), {obstacle<3>("back", Coulomb(coefficient))}, {0, 0, -1});
  };
  const double angle = 0.3;
  EXPECT_EQ(slope(angle, std::tan(angle) * 1.001), "held");
  EXPECT_THAT(slope(angle, std::tan(angle) * 0.9), HasSubstr("friction is too weak"));
  EXPECT_THAT(slope(angle, std::tan(angle) * 0.999), HasSubstr("friction is too weak"));
}

/// Loads a thousandth beyond the cone, in directions between the edges of a polyhedron around it.
TEST(RigidMotion, CoulombIn3DRefusesWhatTheRoundConeDoesNotHold)
{
  constexpr double coefficient = 0.5;
  for (int i = 0; i < 16; ++i)
  {
    const double side = 1.001 * coefficient;
    const double angle = i * std::numbers::pi / 8;
    EXPECT_THAT(verdict<3>(brick(), {obstacle<3>("bottom", Coulomb(coefficient))},
                           {side * std::cos(angle), -1, side * std::sin(angle)}),
                HasSubstr("friction is too weak"))
        << "direction " << i;
  }
}

TEST(RigidMotion, CoulombIn3DRefusesNothingThatTheRoundConeHolds)
{
  constexpr double coefficient = 0.5;
  for (int i = 0; i < 16; ++i)
  {
    const double side = 0.999 * coefficient;
    const double angle = i * std::numbers::pi / 8;
    EXPECT_EQ(verdict<3>(brick(), {obstacle<3>("bottom", Coulomb(coefficient))},
                         {side * std::cos(angle), -1, side * std::sin(angle)}),
              "held")
        << "direction " << i;
  }
}

TEST(RigidMotion, TrescaThresholdTooSmallForTheSideLoad)
{
  // 0.1 on the right side of length 1 against s on the bottom of length 2
  const auto pushed = [](const problem::Field& threshold)
  {
    return verdict<2>(block(), {loaded<2>("top", 0, -1), loaded<2>("right", -0.1, 0),
                                obstacle<2>("bottom", Tresca(threshold))});
  };
  EXPECT_EQ(pushed(0.0501), "held");
  EXPECT_EQ(pushed(formula("0.0502*x")), "held");
  EXPECT_THAT(pushed(0.0499),
              HasSubstr("translation along -x; the friction threshold takes up only 99.8 % of"));
  EXPECT_THAT(pushed(0.025), HasSubstr("translation along -x; the friction threshold takes up "
                                       "only 50 % of their work in it"));
}

/// Strips of friction between the points of the rule hold a force in proportion to their width.
TEST(RigidMotion, TrescaOnANarrowStripCounts)
{
  const auto pulled = [](const std::string& from, double threshold)
  {
    const problem::Field strip =
        formula("x > " + from + " && x < " + from + " + 0.07 ? " + std::to_string(threshold) + " : 0");
    return verdict<2>(box<2>({0, 0}, {1, 1}, {1, 1}), {loaded<2>("top", 0, -1), loaded<2>("right", 1, 0),
                                                       obstacle<2>("bottom", Tresca(strip))});
  };
  for (const std::string from : {"0.34", "0.08", "0.6"})
  {
    EXPECT_EQ(pulled(from, 100), "held");
    EXPECT_EQ(pulled(from, 1.001 / 0.07), "held");
    EXPECT_THAT(pulled(from, 0.999 / 0.07), HasSubstr("takes up only 99.9 % of their work"));
  }
}

TEST(RigidMotion, TrescaBelowARollerThatTakesTheNormalForces)
{
  const auto pushed = [](double threshold)
  {
    return verdict<2>(block(), {fixed<2>("top", free, 0), loaded<2>("right", -0.1, 0),
                                obstacle<2>("bottom", Tresca(threshold))});
  };
  EXPECT_EQ(pushed(0.0501), "held");
  EXPECT_THAT(pushed(0.0499), HasSubstr("drive it into translation along -x"));
}

TEST(RigidMotion, TrescaIn3DAgainstTheDirectionOfTheLoad)
{
  // resultant 0.1 (1, 0, 1) and its moments against s on an area of 2
  const auto pushed = [](double threshold) {
    return verdict<3>(brick(), {obstacle<3>("bottom", Tresca(threshold))}, {0.05, -1, 0.05});
  };
  EXPECT_EQ(pushed(0.0708), "held");
  EXPECT_THAT(pushed(0.0706), HasSubstr("translation along (0.7071, 0, 0.7071)"));
}

/// The body can only move along x, off its inclined floor; only Tresca friction resists.
TEST(RigidMotion, TrescaTooWeakAgainstAPullOffTheFloor)
{
  const double angle = 0.3;
  const auto pulled = [&](double threshold)
  {
    return verdict<2>(on_slope(angle), {fixed<2>("top", free, 0), obstacle<2>("bottom", Tresca(threshold))},
                      {-0.1, 0});
  };
  EXPECT_EQ(pulled(0.1001 / std::cos(angle)), "held");
  EXPECT_THAT(pulled(0.0999 / std::cos(angle)),
              HasSubstr("translation along -x; the friction threshold takes up only 99.9 % of"));
  EXPECT_THAT(pulled(0.003), HasSubstr("takes up only 2.87 % of"));
}

/// An L of three squares with the foot to the right, and frictionless obstacles around it.
mesh::MeshData<2> hook()
{
  mesh::MeshData<2> data = box<2>({0, 0}, {2, 2}, {2, 2});
  std::erase_if(data.cells,
                [&](const mesh::Cell<2>& cell)
                {
                  Point<2> middle = Point<2>::Zero();
                  for (const Index v : cell) middle += data.vertices[v] / 3;
                  return middle[0] > 1 && middle[1] > 1;
                });
  data.regions.resize(data.cells.size());
  data.vertices.pop_back();  // (2, 2)
  std::erase_if(data.facets,
                [](const mesh::TaggedFacet<2>& f) { return f.vertices[0] == 8 || f.vertices[1] == 8; });
  data.boundary_names.insert(data.boundary_names.end(), {"step", "notch"});
  data.facets.push_back({{4, 5}, 4});  // (1, 1)-(2, 1)
  data.facets.push_back({{4, 7}, 5});  // (1, 1)-(1, 2)
  return data;
}

TEST(RigidMotion, HookIsHeldByGeometryAlone)
{
  const auto pushed_from_the_left = [](double traction)
  {
    return verdict<2>(hook(), {obstacle<2>("step"), obstacle<2>("notch"), loaded<2>("bottom", 0, 1),
                               loaded<2>("left", traction, 0)});
  };
  EXPECT_EQ(pushed_from_the_left(1), "held");
  EXPECT_THAT(pushed_from_the_left(-1), HasSubstr("contact cannot hold the body"));
  // A foot on the floor, with its upper side under a ledge: held up, down and against rotation.
  EXPECT_EQ(
      verdict<2>(hook(), {obstacle<2>("bottom"), obstacle<2>("step"), fixed<2>("left", 0, free)}, {0, 1}),
      "held");
}

}  // namespace

}  // namespace tribound::test
