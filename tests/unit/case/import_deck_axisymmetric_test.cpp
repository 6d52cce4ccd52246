/// Decks of axisymmetric elements as cases of bodies of revolution.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <string>

#include "support/input_error.h"
#include "unit/case/import_deck.h"

namespace tribound
{

namespace
{

using test::ImportDeck;
using test::message_of;
using test::one_step;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

/// A disc of radius 2 and height 1.
constexpr std::string_view disc = R"(*NODE
1, 0, 0
2, 1, 0
3, 2, 0
4, 0, 1
5, 1, 1
6, 2, 1
*ELEMENT, TYPE=CAX4R, ELSET=disc
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NSET, NSET=base
1, 2, 3
*NSET, NSET=axis
1, 4
*SURFACE, NAME=top
disc, S3
*MATERIAL, NAME=steel
*ELASTIC
210000., .3
*DENSITY
2.
*SOLID SECTION, ELSET=disc, MATERIAL=steel
7.
*BOUNDARY
base, 2, 2
axis, 1, 1
)";

class ImportDisc : public ImportDeck
{
 protected:
  case_file::ImportedDeck import_disc(const std::string& loads, const std::string& model = {},
                                      const std::set<std::string>& accepted = {})
  {
    return import(fmt::format("{}{}{}{}*END STEP\n", disc, model, one_step, loads), accepted);
  }
};

TEST_F(ImportDisc, IsABodyOfRevolution)
{
  const case_file::ImportedDeck deck = import_disc("*DSLOAD\ntop, P, 2.5\n");
  const case_file::Config config = config_of(deck);
  EXPECT_TRUE(config.is_axisymmetric);
  EXPECT_EQ(value(*boundary(config, "top").pressure, 1), 2.5) << "the thickness has no meaning";
  EXPECT_TRUE(boundary(config, "axis").displacement[0]);
  EXPECT_FALSE(boundary(config, "axis").displacement[1]);
  EXPECT_TRUE(config.not_covered.empty());
}

TEST_F(ImportDisc, ForcesAtNodesAreOverTheFullCircle)
{
  // 2 pi int r N_i of a traction of 3 along the axis.
  const std::string forces =
      fmt::format("*CLOAD\n4, 2, {}\n5, 2, {}\n6, 2, {}\n", 2 * pi * 3 / 6, 2 * pi * 3, 2 * pi * 3 * 5 / 6);
  const case_file::ImportedDeck deck = import_disc(forces);
  const case_file::Config config = config_of(deck);
  const auto pulled =
      std::ranges::find_if(config.boundaries, [](const auto& b) { return !b.traction.empty(); });
  ASSERT_NE(pulled, config.boundaries.end());
  EXPECT_NEAR(value(pulled->traction[1], 1), 3, 1e-12);
  EXPECT_TRUE(config.not_covered.empty()) << "they are those of a uniform traction";
}

TEST_F(ImportDisc, NodesOnTheAxisNeedNoForceInSecondOrder)
{
  const std::string deck = fmt::format(
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 1\n4, 0, 1\n5, 1, 0\n6, 2, .5\n7, 1, 1\n8, 0, .5\n"
      "*ELEMENT, TYPE=CAX8, ELSET=disc\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=base\n1, 2, 5\n"
      "*MATERIAL, NAME=m\n*ELASTIC\n1., .3\n*SOLID SECTION, ELSET=disc, MATERIAL=m\n*BOUNDARY\nbase, 2, 2\n"
      "{}*CLOAD\n3, 2, {}\n7, 2, {}\n*END STEP\n",
      one_step, 2 * pi * 5 * 2 / 3, 2 * pi * 5 * 4 / 3);
  const case_file::Config config = config_of(import(deck));
  const auto pulled =
      std::ranges::find_if(config.boundaries, [](const auto& b) { return !b.traction.empty(); });
  ASSERT_NE(pulled, config.boundaries.end());
  EXPECT_NEAR(value(pulled->traction[1], 1), 5, 1e-12);
  EXPECT_TRUE(config.not_covered.empty());
}

TEST_F(ImportDisc, NodesOnTheAxisAreHeldInAnyCase)
{
  EXPECT_TRUE(config_of(import_disc("", "*BOUNDARY\n4, 1, 1\n")).not_covered.empty());
  EXPECT_THAT(message_of([&] { return import_disc("", "*BOUNDARY\n5, 1, 1\n"); }),
              HasSubstr("component 1 of node 5, which lies on no face"));
  EXPECT_THAT(message_of([&] { return import_disc("*CLOAD\n1, 2, 1.\n4, 2, 1.\n"); }),
              HasSubstr("forces at single nodes, such as node 1"));
}

TEST_F(ImportDisc, WeightAndRotationAreAboutTheAxis)
{
  const case_file::Config config =
      config_of(import_disc("*DLOAD\ndisc, GRAV, 10., 0, -1, 0\ndisc, CENTRIF, 9., 0, 4, 0, 0, 1, 0\n"));
  ASSERT_EQ(config.loads.size(), 1U);
  const Point<3> x(1.5, 0.5, 0);
  EXPECT_NEAR(value(config.loads[0].body[0], 1, x), 2 * 9 * 1.5, 1e-12);
  EXPECT_NEAR(value(config.loads[0].body[1], 1, x), -20, 1e-12);
  for (const char* load :
       {"GRAV, 10., 1, 0, 0", "CENTRIF, 9., 0, 0, 0, 0, 0, 1", "CENTRIF, 9., 1, 0, 0, 0, 1, 0"})
    EXPECT_THAT(message_of([&] { return import_disc(fmt::format("*DLOAD\ndisc, {}\n", load)); }),
                HasSubstr("has no direction in which it can act"));
}

/// The top of the disc moves with node 99.
struct RigidTop
{
  const char* constraint;
  const char* keyword;
};

constexpr std::array rigid_tops = {
    RigidTop{"*NODE\n99, 0., 3.\n98, 0., 3.\n*RIGID BODY, NSET=lid, REFNODE=99, ROTNODE=98\n"
             "*BOUNDARY\n98, 3, 3\n",
             "RIGID BODY"},
    RigidTop{"*NODE\n99, 0., 3.\n*COUPLING, REFNODE=99, SURFACE=top, CONSTRAINTNAME=c\n*KINEMATIC\n1, 2\n"
             "*BOUNDARY\n99, 6, 6\n",
             "COUPLING"}};

TEST_F(ImportDisc, RigidPartsMoveAlongTheAxis)
{
  for (const auto& [constraint, keyword] : rigid_tops)
  {
    const std::string model = fmt::format("*NSET, NSET=lid\n4, 5, 6\n{}", constraint);
    const auto rigid_of = [&](const case_file::Config& config) -> const case_file::RigidConfig&
    {
      return *std::ranges::find_if(config.boundaries, [](const auto& b) { return b.rigid.has_value(); })
                  ->rigid;
    };
    const case_file::Config pressed =
        config_of(import_disc("*CLOAD\n99, 2, -7.\n99, 1, 5.\n", model + "*BOUNDARY\n99, 1, 1\n"));
    EXPECT_EQ(value(rigid_of(pressed).force[0], 1), 0) << "its support carries the radial force";
    EXPECT_EQ(value(rigid_of(pressed).force[1], 1), -7) << "of the full circle";
    EXPECT_TRUE(rigid_of(pressed).moment.empty());
    EXPECT_TRUE(pressed.not_covered.empty());

    const case_file::Config moved =
        config_of(import_disc("*BOUNDARY\n99, 2, 2, -.1\n", model + "*BOUNDARY\n99, 1, 1\n"));
    const auto lid = std::ranges::find_if(
        moved.boundaries, [](const auto& b) { return b.displacement[0] && b.displacement[1]; });
    ASSERT_NE(lid, moved.boundaries.end());
    EXPECT_EQ(value(*lid->displacement[0], 1), 0);
    EXPECT_EQ(value(*lid->displacement[1], 1), -0.1);

    const std::string free = message_of([&] { return import_disc("*CLOAD\n99, 2, -7.\n", model); });
    EXPECT_THAT(free, HasSubstr(fmt::format("*{}: ", keyword)));
    EXPECT_THAT(free, HasSubstr("x of the reference node is free"));
    const case_file::Config accepted = config_of(import_disc("*CLOAD\n99, 2, -7.\n", model, {keyword}));
    EXPECT_EQ(value(rigid_of(accepted).force[1], 1), -7);
    EXPECT_THAT(accepted.not_covered, testing::ElementsAre(HasSubstr("moves along the axis alone")));
  }
}

/// A ring on the disc, pressed on it by two steps.
TEST_F(ImportDisc, TouchesWithFrictionInItsSteps)
{
  const std::string ring =
      "*NODE\n11, 1, 1\n12, 2, 1\n13, 2, 2\n14, 1, 2\n*ELEMENT, TYPE=CAX4, ELSET=ring\n9, 11, 12, 13, 14\n"
      "*SURFACE, NAME=foot\nring, S1\n*SURFACE, NAME=head\nring, S3\n"
      "*SOLID SECTION, ELSET=ring, MATERIAL=steel\n*SURFACE INTERACTION, NAME=touch\n*FRICTION\n.3\n"
      "*CONTACT PAIR, INTERACTION=touch\nfoot, top\n";
  const std::string steps = "*DSLOAD\nhead, P, 1.\n*END STEP\n*STEP\n*STATIC\n.5, 1.\n*DSLOAD\nhead, P, 4.\n";
  const case_file::Config config = config_of(import_disc(steps, ring));
  ASSERT_EQ(config.contacts.size(), 1U);
  ASSERT_EQ(config.quantities.size(), 1U);
  EXPECT_THAT(config.quantities[0].direction, testing::ElementsAre(0, 1));
  ASSERT_TRUE(config.history);
  EXPECT_NEAR(value(*boundary(config, "head").pressure, 1.5), 2.5, 1e-12);
}

/// A ring around the disc: the force with which it is pressed on it is radial.
TEST_F(ImportDisc, ForcesOnCylindersAreRadial)
{
  const std::string ring =
      "*NODE\n11, 2, 0\n12, 3, 0\n13, 3, 1\n14, 2, 1\n*ELEMENT, TYPE=CAX4, ELSET=ring\n9, 11, 12, 13, 14\n"
      "*SURFACE, NAME=bore\nring, S4\n*SURFACE, NAME=rim\n2, S2\n"
      "*SOLID SECTION, ELSET=ring, MATERIAL=steel\n*SURFACE INTERACTION, NAME=touch\n"
      "*CONTACT PAIR, INTERACTION=touch\nbore, rim\n*CLEARANCE, SLAVE=bore, MASTER=rim, VALUE=-.01\n"
      "*NSET, NSET=foot\n11, 12\n*BOUNDARY\nfoot, 2, 2\n";
  const case_file::Config config = config_of(import_disc("", ring));
  ASSERT_EQ(config.quantities.size(), 1U);
  EXPECT_EQ(config.quantities[0].boundary, "bore");
  EXPECT_TRUE(config.quantities[0].direction.empty()) << "the mean normal";
}

TEST_F(ImportDisc, PlaneElementsBesideItAreRefused)
{
  const std::string plane =
      "*NODE\n11, 5, 0\n12, 6, 0\n13, 5, 1\n*ELEMENT, TYPE=CPE3, ELSET=plane\n9, 11, 12, 13\n"
      "*SOLID SECTION, ELSET=plane, MATERIAL=steel\n";
  EXPECT_THAT(message_of([&] { return import_disc("", plane); }),
              HasSubstr("CPE3 beside CAX4R: plane strain and axisymmetry in one deck"));
}

}  // namespace

}  // namespace tribound
