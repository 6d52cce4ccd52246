/// @file rigid_motion_test.cpp
/// What displacement conditions hold, and how motions of unsupported bodies are described.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tribound/contact/nitsche/rigid_modes.h"
#include "unit/contact/rigid_motion_testing.h"

namespace tribound::test
{

namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(RigidMotion, FreeBodyHasAllMotions)
{
  EXPECT_THAT(verdict<2>(block(), {loaded<2>("top", 0, 1)}),
              HasSubstr("boundary: nothing stops the body (region \"box\") from: translation along x; "
                        "translation along y; rotation about (1, 0.5)"));
  EXPECT_THAT(verdict<3>(brick(), {}),
              HasSubstr("translation along x; translation along y; translation along z; rotation about the "
                        "axis through (1, 0.5, 0.5) along (1, 0, 0); rotation about "
                        "the axis through (1, 0.5, 0.5) along (0, 1, 0); rotation about the axis through "
                        "(1, 0.5, 0.5) along (0, 0, 1)"));
}

TEST(RigidMotion, ClampedBodyIsHeldWhateverTheLoad)
{
  EXPECT_EQ(verdict<2>(block(), {clamped<2>("left"), loaded<2>("top", 3, 1)}), "held");
  EXPECT_EQ(verdict<3>(brick(), {clamped<3>("left")}, {1, 1, 1}), "held");
}

TEST(RigidMotion, RigidPartHoldsOnlyWhatItIsFixedIn)
{
  problem::BoundaryCondition<2> platen;
  platen.name = "top";
  platen.rigid.emplace().point = {1, 1};
  platen.rigid->force[1] = -1;
  EXPECT_THAT(verdict<2>(block(), {platen}), HasSubstr("translation along y; rotation about"));
  platen.rigid->fixed = {true, false, true};
  EXPECT_THAT(verdict<2>(block(), {platen}),
              AllOf(HasSubstr("translation along y"), Not(HasSubstr("rotation"))));
  platen.rigid->fixed = {true, true, false};
  EXPECT_THAT(verdict<2>(block(), {platen}),
              AllOf(HasSubstr("rotation about (1, 1)"), Not(HasSubstr("translation"))));
  platen.rigid->fixed = {true, false, false};
  platen.rigid->point = {1, 5000};
  EXPECT_EQ(verdict<2>(block(), {platen, fixed<2>("bottom", free, 0.0)}), "held");
  platen.rigid->fixed = {true, true, true};
  EXPECT_EQ(verdict<2>(block(), {platen}), "held");
}

TEST(RigidMotion, RollerLeavesTheMotionAlongIt)
{
  const std::string said = verdict<2>(block(), {fixed<2>("bottom", free, 0)});
  EXPECT_THAT(said, AllOf(HasSubstr("from: translation along x\n"), HasSubstr("hint: fix")));
  EXPECT_THAT(said, Not(HasSubstr("friction")));
  EXPECT_THAT(verdict<3>(brick(), {fixed<3>("bottom", free, 0, free)}),
              HasSubstr("from: translation along x; translation along z; rotation about the "
                        "axis through (1, 0.5, 0.5) along (0, 1, 0)\n"));
}

TEST(RigidMotion, SlidersThroughAPointLeaveTheRotationAboutIt)
{
  EXPECT_THAT(verdict<2>(block(), {fixed<2>("bottom", 0, free), fixed<2>("left", free, 0)}),
              HasSubstr("from: rotation about (0, 0)\n"));
  EXPECT_THAT(verdict<3>(brick(), {fixed<3>("bottom", 0, free, free), fixed<3>("left", free, 0, free),
                                   fixed<3>("front", free, free)}),
              HasSubstr("from: rotation about the axis through (0, 0, 0.5) along (0, 0, 1)\n"));
}

/// A component normal to an unloaded side; each is named once.
TEST(RigidMotion, NamesAComponentThatWouldStopTheMotion)
{
  EXPECT_THAT(verdict<2>(block(), {loaded<2>("left", 1, 0), loaded<2>("top", 0, 1)}),
              HasSubstr("change, for example x on boundary \"right\", y on boundary \"bottom\" (symmetry:"));
  EXPECT_THAT(verdict<3>(brick(), {fixed<3>("bottom", 0, 0, free)}),
              HasSubstr("for example z on boundary \"back\" (symmetry:"));
}

TEST(RigidMotion, WordsForAScrew)
{
  const contact::RigidModes<3> modes{.centre = {0, 0, 0}, .size = 2};
  contact::RigidModes<3>::Coefficients motion;
  motion << 1, 0, 3, 0, 0, 1;  // about the vertical axis at y = 2, where its horizontal part vanishes
  EXPECT_EQ(modes.describe(motion), "screw motion about the axis through (0, 2, 0) along (0, 0, 1)");
}

TEST(RigidMotion, RollersOnTwoPlanesLeaveTheirCommonDirection)
{
  EXPECT_EQ(verdict<2>(block(), {fixed<2>("bottom", free, 0), fixed<2>("left", 0, free)}), "held");
  EXPECT_THAT(verdict<3>(brick(), {fixed<3>("left", 0, free, free), fixed<3>("bottom", free, 0, free)}),
              HasSubstr("from: translation along z\n"));
}

TEST(RigidMotion, BodiesAreLookedAtOneByOne)
{
  const mesh::MeshData<2> two = side_by_side(block(), box<2>({5, 0}, {6, 2}, {1, 2}), "2");
  const std::string said =
      verdict<2>(two, {clamped<2>("left"), fixed<2>("bottom2", free, 0), fixed<2>("right2", free, 0)});
  EXPECT_THAT(said, HasSubstr("nothing stops the body around (5.5, 1) (region \"box2\") from: translation "
                              "along x\n"));
}

TEST(RigidMotion, TwoRegionsOfOneBodyAreNamedTogether)
{
  mesh::MeshData<2> data = block();
  data.region_names = {"steel", "rubber"};
  data.regions.back() = 1;
  EXPECT_THAT(verdict<2>(data, {}), HasSubstr("the body (regions \"steel\", \"rubber\")"));
}

}  // namespace

}  // namespace tribound::test
