/// @file support_facts_test.cpp
/// Motions that contact alone stops, what to fix against a motion, and corners with too many conditions.

#include "tribound/doctor/support_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/discrete_case.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string material = "material = { E = 1, nu = 0.3 }\n";

DiscreteCase<2> block(const std::string& toml)
{
  return {material + toml, box<2>({0, 0}, {2, 1}, {4, 2})};
}

TEST(SupportFacts, ClampedBodyNeedsNoContact)
{
  const auto c = block("boundary.left.displacement = [0, 0]\nboundary.bottom.contact = {}");
  EXPECT_THAT(doctor::motions_held_by_contact(c.form), IsEmpty());
}

TEST(SupportFacts, RollerLeavesTheVerticalMotionToContact)
{
  const auto c = block(
      "boundary.left.displacement = [0, \"free\"]\nboundary.bottom.contact = {}\nboundary.top.pressure = 1");
  const auto motions = doctor::motions_held_by_contact(c.form);
  ASSERT_THAT(motions, SizeIs(1));
  EXPECT_EQ(motions[0].body, "the body (region \"box\")");
  EXPECT_EQ(motions[0].motion, "translation along y");
  EXPECT_FALSE(motions[0].by_friction);
  // The top would be the better side, but it is loaded: of the others none faces y.
  ASSERT_TRUE(motions[0].remedy);
  EXPECT_NE(motions[0].remedy->boundary, "top");
  EXPECT_EQ(motions[0].remedy->component, 1);
}

/// Numbers of the boundaries along which a body would slide as a whole.
template <int dim>
std::vector<std::string> sliding_boundaries(const DiscreteCase<dim>& c)
{
  const std::vector<bool> slides = doctor::slides_as_a_whole(c.form);
  std::vector<std::string> names;
  for (std::size_t tag = 0; tag < slides.size(); ++tag)
    if (slides[tag]) names.push_back(c.problem.boundaries()[tag].name);
  return names;
}

const std::string friction = "contact = { friction = \"coulomb\", coefficient = 0.3 }\n";

TEST(SupportFacts, SlidingIsJudgedWhereFrictionAloneHoldsTheBody)
{
  EXPECT_THAT(sliding_boundaries(block("boundary.bottom." + friction)), ElementsAre("bottom"));
  EXPECT_THAT(
      sliding_boundaries(block("boundary.bottom." + friction + "boundary.left.displacement = [\"free\", 0]")),
      ElementsAre("bottom"));
  // A plane of symmetry, or a frictionless wall, takes the force that would make it slide.
  EXPECT_THAT(
      sliding_boundaries(block("boundary.bottom." + friction + "boundary.left.displacement = [0, \"free\"]")),
      IsEmpty());
  EXPECT_THAT(sliding_boundaries(block("boundary.bottom." + friction + "boundary.left.contact = {}")),
              IsEmpty());
}

TEST(SupportFacts, SlidingIsJudgedOnPlaneBoundariesOnly)
{
  const auto arch = [](double height)
  {
    return mapped<2>(box<2>({0, 0}, {2, 1}, {4, 2}),
                     [=](const Point<2>& x) -> Point<2> {
                       return {x[0], x[1] + height * x[0] * (2 - x[0])};
                     });
  };
  const std::string toml = material + "boundary.bottom." + friction;
  EXPECT_THAT(sliding_boundaries(DiscreteCase<2>(toml, arch(0.05))), ElementsAre("bottom"));
  EXPECT_THAT(sliding_boundaries(DiscreteCase<2>(toml, arch(0.3))), IsEmpty());
}

TEST(SupportFacts, LooseBlockIsHeldByPressureAndFriction)
{
  const auto c = block("boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.3 }");
  const auto motions = doctor::motions_held_by_contact(c.form);
  ASSERT_THAT(motions, SizeIs(3));
  EXPECT_EQ(motions[0].motion, "translation along y");
  EXPECT_FALSE(motions[0].by_friction);
  EXPECT_THAT(motions[1].motion, ::testing::StartsWith("rotation about"));
  EXPECT_FALSE(motions[1].by_friction);
  EXPECT_EQ(motions[2].motion, "translation along x");
  EXPECT_TRUE(motions[2].by_friction);
  EXPECT_EQ(motions[2].remedy, (contact::Remedy{"left", 0}));
  EXPECT_EQ(motions[0].remedy, (contact::Remedy{"top", 1}));
}

TEST(SupportFacts, NoRemedyWhereAllIsContact)
{
  const auto c = block(
      "boundary.left.contact = {}\nboundary.right.contact = {}\nboundary.top.contact = {}\n"
      "boundary.bottom.contact = {}");
  for (const doctor::ContactHeldMotion& motion : doctor::motions_held_by_contact(c.form))
    EXPECT_FALSE(motion.remedy);
}

TEST(SupportFacts, ClampedCorner)
{
  const auto c = block(
      "boundary.left.displacement = [0, 0]\nboundary.bottom.contact = { friction = \"tresca\", threshold = 1 "
      "}");
  const auto corners = doctor::overconstrained_corners(c.form);
  ASSERT_THAT(corners, SizeIs(1));
  EXPECT_EQ(corners[0].contact, "bottom");
  EXPECT_EQ(corners[0].displacement, "left");
  EXPECT_EQ(corners[0].vertices, 1);
  EXPECT_THAT(corners[0].where, ElementsAre(0, 0));
  EXPECT_TRUE(corners[0].sticks);
  EXPECT_FALSE(corners[0].contradicts());
}

TEST(SupportFacts, SymmetryDoesNotConstrainTheNormal)
{
  const auto c = block("boundary.left.displacement = [0, \"free\"]\nboundary.bottom.contact = {}");
  EXPECT_THAT(doctor::overconstrained_corners(c.form), IsEmpty());
}

TEST(SupportFacts, DisplacementBeyondTheGap)
{
  const auto c = block(
      "boundary.left.displacement = [\"free\", -0.25]\nboundary.right.displacement = [0, \"-0.1*y\"]\n"
      "boundary.bottom.contact = { gap = 0.125 }");
  const auto corners = doctor::overconstrained_corners(c.form);
  ASSERT_THAT(corners, SizeIs(2));
  EXPECT_EQ(corners[0].displacement, "left");
  EXPECT_EQ(corners[0].normal, 0.25);
  EXPECT_EQ(corners[0].gap, 0.125);
  EXPECT_TRUE(corners[0].contradicts());
  EXPECT_FALSE(corners[0].sticks);
  EXPECT_EQ(corners[1].displacement, "right");
  EXPECT_FALSE(corners[1].contradicts());
}

TEST(SupportFacts, EdgeIn3DCountsItsVertices)
{
  const DiscreteCase<3> c(
      material + "boundary.left.displacement = [0, \"free\", \"0.01*y\"]\nboundary.back.contact = {}",
      box<3>({0, 0, 0}, {1, 1, 1}, {1, 3, 1}));
  const auto corners = doctor::overconstrained_corners(c.form);
  ASSERT_THAT(corners, SizeIs(1));
  EXPECT_EQ(corners[0].vertices, 4);
  EXPECT_THAT(corners[0].where, ElementsAre(0, 0, 0));  // where the body is closest to the obstacle
  EXPECT_EQ(corners[0].normal, 0);
}

}  // namespace

}  // namespace tribound::test
