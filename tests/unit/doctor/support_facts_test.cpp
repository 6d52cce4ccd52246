/// @file support_facts_test.cpp
/// Motions that only contact stops, what to fix against a motion, and corners with too many conditions.

#include "tribound/doctor/support_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

DiscreteProblem<2> block_with(const std::vector<problem::BoundaryCondition<2>>& boundaries)
{
  return {block<2>({4, 2}), {.boundaries = boundaries}};
}

TEST(SupportFacts, ClampedBodyNeedsNoContact)
{
  const auto c = block_with({clamped<2>("left"), obstacle<2>("bottom")});
  EXPECT_THAT(doctor::motions_held_by_contact(c.form), IsEmpty());
}

TEST(SupportFacts, RollerLeavesTheVerticalMotionToContact)
{
  const auto c = block_with({fixed<2>("left", 0, free), obstacle<2>("bottom"), pressed<2>("top", 1)});
  const auto motions = doctor::motions_held_by_contact(c.form);
  ASSERT_THAT(motions, SizeIs(1));
  EXPECT_EQ(motions[0].body, "the body (region \"box\")");
  EXPECT_EQ(motions[0].motion, "translation along y");
  EXPECT_FALSE(motions[0].by_friction);
  // The top would be the better side, but it is loaded; none of the others faces y.
  ASSERT_TRUE(motions[0].remedy);
  EXPECT_NE(motions[0].remedy->boundary, "top");
  EXPECT_EQ(motions[0].remedy->component, 1);
}

/// Numbers of the boundaries along which a body would slide as a whole.
template <int dim>
std::vector<std::string> sliding_boundaries(const DiscreteProblem<dim>& c)
{
  const std::vector<bool> slides = doctor::slides_as_a_whole(c.problem, c.mesh);
  std::vector<std::string> names;
  for (std::size_t tag = 0; tag < slides.size(); ++tag)
    if (slides[tag]) names.push_back(c.problem.boundaries()[tag].name);
  return names;
}

const auto rough_floor = obstacle<2>("bottom", Coulomb(0.3));

TEST(SupportFacts, SlidingIsJudgedWhereFrictionAloneHoldsTheBody)
{
  EXPECT_THAT(sliding_boundaries(block_with({rough_floor})), ElementsAre("bottom"));
  EXPECT_THAT(sliding_boundaries(block_with({rough_floor, fixed<2>("left", free, 0)})),
              ElementsAre("bottom"));
  // A plane of symmetry or a frictionless wall takes the force that would make the body slide.
  EXPECT_THAT(sliding_boundaries(block_with({rough_floor, fixed<2>("left", 0, free)})), IsEmpty());
  EXPECT_THAT(sliding_boundaries(block_with({rough_floor, obstacle<2>("left")})), IsEmpty());
}

TEST(SupportFacts, SlidingIsJudgedOnPlaneBoundariesOnly)
{
  const auto arch = [](double height)
  {
    const auto bend = [=](const Point<2>& x) -> Point<2> {
      return {x[0], x[1] + height * x[0] * (2 - x[0])};
    };
    return sliding_boundaries(
        DiscreteProblem<2>(mapped<2>(block<2>({4, 2}), bend), {.boundaries = {rough_floor}}));
  };
  EXPECT_THAT(arch(0.05), ElementsAre("bottom"));
  EXPECT_THAT(arch(0.3), IsEmpty());
}

TEST(SupportFacts, LooseBlockIsHeldByPressureAndFriction)
{
  const auto c = block_with({obstacle<2>("bottom", Coulomb(0.3))});
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
  const auto c =
      block_with({obstacle<2>("left"), obstacle<2>("right"), obstacle<2>("top"), obstacle<2>("bottom")});
  for (const doctor::ContactHeldMotion& motion : doctor::motions_held_by_contact(c.form))
    EXPECT_FALSE(motion.remedy);
}

TEST(SupportFacts, ClampedCorner)
{
  const auto c = block_with({clamped<2>("left"), obstacle<2>("bottom", Tresca(1))});
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
  const auto c = block_with({fixed<2>("left", 0, free), obstacle<2>("bottom")});
  EXPECT_THAT(doctor::overconstrained_corners(c.form), IsEmpty());
}

TEST(SupportFacts, DisplacementBeyondTheGap)
{
  const auto c = block_with({fixed<2>("left", free, -0.25), fixed<2>("right", 0, formula("-0.1*y")),
                             obstacle<2>("bottom", Frictionless(), 0.125)});
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
  const DiscreteProblem<3> c(
      box<3>({0, 0, 0}, {1, 1, 1}, {1, 3, 1}),
      {.boundaries = {fixed<3>("left", 0, free, formula("0.01*y")), obstacle<3>("back")}});
  const auto corners = doctor::overconstrained_corners(c.form);
  ASSERT_THAT(corners, SizeIs(1));
  EXPECT_EQ(corners[0].vertices, 4);
  EXPECT_THAT(corners[0].where, ElementsAre(0, 0, 0));  // where the body is closest to the obstacle
  EXPECT_EQ(corners[0].normal, 0);
}

}  // namespace

}  // namespace tribound::test
