/// Decks as cases: what the keywords of the model become, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

#include "support/damaged.h"
#include "support/input_error.h"
#include "tribound/case/deck/groups.h"
#include "unit/case/import_deck.h"

namespace tribound
{

namespace
{

using case_file::ImportedDeck;
using test::ImportDeck;
using test::message_of;
using test::one_step;
using test::two_cubes;
using testing::HasSubstr;
using testing::Not;

TEST_F(ImportDeck, MakesACaseOfTwoCubes)
{
  const ImportedDeck deck = import("", "*DSLOAD\ncrown, P, 2.5\n");
  const case_file::Config config = config_of(deck);
  EXPECT_EQ(config.title, "Two cubes, hand made");
  ASSERT_EQ(config.materials.size(), 2U);
  EXPECT_EQ(config.materials[0].E, 210000);
  EXPECT_EQ(config.materials[0].nu, 0.3);
  ASSERT_EQ(config.contacts.size(), 1U);
  EXPECT_THAT(config.contacts[0].slave, testing::ElementsAre("above"));
  EXPECT_THAT(config.contacts[0].master, testing::ElementsAre("below"));
  EXPECT_EQ(boundary(config, "base").displacement.size(), 3U);
  EXPECT_EQ(value(*boundary(config, "crown").pressure, 1), 2.5);
  EXPECT_FALSE(config.history);
  EXPECT_THAT(config.not_covered, testing::Contains(HasSubstr("stiffness (LINEAR) is dropped")));
  EXPECT_THAT(deck.case_text, HasSubstr("*SURFACE BEHAVIOR"));
  EXPECT_EQ(deck.mesh.cell_sets.size(), 2U);
  EXPECT_EQ(deck.mesh.facet_sets.size(), 4U);
}

TEST_F(ImportDeck, AdjustsAndClears)
{
  const auto with = [&](const std::string& pair, double shift)
  {
    std::string text(two_cubes);
    text.replace(text.find("TYPE=NODE TO SURFACE"), 20, pair);
    for (const char* node : {"11, 0, 0, 1", "12, 1, 0, 1", "13, 1, 1, 1", "14, 0, 1, 1"})
    {
      const std::string moved = fmt::format("{}{}", std::string(node).substr(0, 10), 1 + shift);
      text.replace(text.find(node), 11, moved);
    }
    return import(text + std::string(one_step) + "*DSLOAD\ncrown, P, 1.\n*END STEP\n").case_text;
  };
  EXPECT_THAT(with("ADJUST=.02", 0.01), HasSubstr("gap = 0"));
  EXPECT_THAT(with("ADJUST=0.", -0.01), HasSubstr("gap = 0"));
  EXPECT_THAT(with("ADJUST=.005", 0.01), Not(HasSubstr("gap = 0")));
  EXPECT_THAT(with("ADJUST=.005", 0.01), HasSubstr("farther apart than 0.005"));
  const case_file::Config config =
      config_of(import("*CLEARANCE, SLAVE=above, MASTER=below, VALUE=-1.E-3\n", "*DSLOAD\ncrown, P, 1.\n"));
  EXPECT_EQ(value(*config.contacts[0].contact.gap, 1), -1e-3);
}

TEST_F(ImportDeck, MakesRigidParts)
{
  const std::string reference = "*NODE\n99, .5, .5, 3.\n98, .5, .5, 3.\n";
  const case_file::Config body = config_of(
      import(reference + "*RIGID BODY, NSET=top, REF NODE=99, ROT NODE=98\n*BOUNDARY\n99, 1, 2\n98, 3, 3\n",
             "*CLOAD\n99, 3, -7.\n98, 1, 2.\n"));
  const case_file::RigidConfig& rigid = *boundary(body, "top").rigid;
  EXPECT_EQ(value(rigid.force[2], 1), -7);
  EXPECT_EQ(value(rigid.moment[0], 1), 2);
  EXPECT_THAT(rigid.point, testing::ElementsAre(0.5, 0.5, 3));
  EXPECT_THAT(rigid.fixed, testing::ElementsAre("x", "y", "rz"));

  const std::string coupling = "*COUPLING, REF NODE=99, SURFACE=crown, CONSTRAINT NAME=c\n*KINEMATIC\n1, 3\n";
  const case_file::Config moved = config_of(
      import(reference + coupling, "*BOUNDARY\n99, 1, 2\n99, 3, 3, -.1\n99, 4, 5\n99, 6, 6, .01\n"));
  const case_file::BoundaryConfig& crown = boundary(moved, "crown");
  const Point<3> x(2, 5, 7);
  EXPECT_NEAR(value(*crown.displacement[0], 1, x), -0.01 * 4.5, 1e-15);
  EXPECT_NEAR(value(*crown.displacement[1], 1, x), 0.01 * 1.5, 1e-15);
  EXPECT_EQ(value(*crown.displacement[2], 1, x), -0.1);

  EXPECT_THAT(message_of([&] { return import(reference + coupling, "*BOUNDARY\n99, 3, 3, -.1\n"); }),
              HasSubstr("z is given, and other motions are free"));
}

struct Refused
{
  const char* model;
  const char* loads;
  const char* message;
  const char* accept;  ///< empty: cannot be accepted
};

TEST_F(ImportDeck, NamesWhatItCannotTake)
{
  const Refused cases[] = {
      {"*EQUATION\n2\n1, 1, 1., 2, 1, -1.\n", "", "*EQUATION: has no counterpart", "EQUATION"},
      {"*MATERIAL, NAME=soft\n*PLASTIC\n100., 0.\n", "", "*PLASTIC: has no counterpart", "PLASTIC"},
      {"*MATERIAL, NAME=soft\n*ELASTIC, TYPE=ORTHO\n1., 2.\n", "", "are not isotropic", ""},
      {"", "*DYNAMIC\n", "only static steps", ""},
      {"", "*BOUNDARY, OP=NEW\n", "OP=NEW ends that of base", ""},
      {"", "*BOUNDARY\n15, 1, 1\n", "node 15, which lies on no face that is held", "BOUNDARY"},
      {"", "*DLOAD\nupper, BX, 1.\n", "the load \"BX\" cannot be imported", "DLOAD"},
      {"*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nupper\n", "", "*MODEL CHANGE", "MODEL CHANGE"},
      {"*AMPLITUDE, NAME=a, DEFINITION=PERIODIC\n", "", "only tables", ""},
      {"*NSET, NSET=none, GENERATE\n100, 200\n", "*BOUNDARY\nnone, 1\n", "the set \"none\" is empty", ""},
      {"*ELSET, ELSET=both\n1, 2\n*SOLID SECTION, ELSET=both, MATERIAL=steel\n", "", "every element once",
       ""},
      {"*SURFACE INTERACTION, NAME=glue\n*SURFACE BEHAVIOR, NO SEPARATION\n", "", "NOSEPARATION",
       "SURFACE BEHAVIOR"},
      {"*AMPLITUDE, NAME=a, VALUE=ABSOLUTE\n0., 0., 1., 1.\n", "", "VALUE=ABSOLUTE", "AMPLITUDE"},
      {"*CLOAD\ntop, 1, 1.\n", "", "stands outside of the steps", ""},
      {"", "*DLOAD\n2, P2, 1.\n2, P2, 1.\n", "has the load twice", ""},
      {"", "*DSLOAD\ncrown, TRVEC, 1.\n", "TRVEC has no direction", ""},
      {"", "*BOUNDARY\ntop, 3, 1\n", "the components 3 to 1 are none", ""},
      {"*CLEARANCE, SLAVE=none, MASTER=below, VALUE=1\n", "", "there is no contact pair", ""},
  };
  for (const Refused& c : cases)
  {
    EXPECT_THAT(message_of([&] { return import(c.model, c.loads); }), HasSubstr(c.message));
    const std::string accepted = message_of([&] { return import(c.model, c.loads, {c.accept}); });
    EXPECT_EQ(accepted.empty(), *c.accept != 0) << c.message << accepted;
  }
  const std::string nonlinear = fmt::format("{}*STEP, NLGEOM\n*STATIC\n*END STEP\n", two_cubes);
  EXPECT_THAT(message_of([&] { return import(nonlinear); }), HasSubstr("--accept \"NLGEOM\""));
  EXPECT_THAT(config_of(import(nonlinear, std::set<std::string>{"NLGEOM"})).not_covered,
              testing::Contains(HasSubstr("strains and rotations are small")));
}

TEST_F(ImportDeck, ReportsAllProblemsAtOnce)
{
  const std::string message =
      message_of([&] { return import("*EQUATION\n*TRANSFORM\n", "*DLOAD\nupper, BX, 1.\n"); });
  for (const char* problem : {"*EQUATION", "*TRANSFORM", "*DLOAD"}) EXPECT_THAT(message, HasSubstr(problem));
}

TEST_F(ImportDeck, HoldsPrismsByTheirEnds)
{
  const std::string all = "*NSET, NSET=all\n1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18\n";
  const case_file::Config config =
      config_of(import(all + "*BOUNDARY\nall, 2, 2\n", "*DSLOAD\ncrown, P, 1.\n"));
  const case_file::BoundaryConfig& ends = boundary(config, "all");
  ASSERT_EQ(ends.displacement.size(), 3U);
  EXPECT_FALSE(ends.displacement[0]);
  EXPECT_EQ(value(*ends.displacement[1], 1), 0);
  EXPECT_THAT(config.not_covered, testing::Contains(HasSubstr("held on the faces across it alone")));
}

TEST_F(ImportDeck, ShowsTextsOfAnyBytes)
{
  std::string text = fmt::format("{}{}*END STEP\n", two_cubes, one_step);
  text.replace(text.find("Two cubes"), 9, "W\xfcrfel");
  EXPECT_EQ(config_of(import(text)).title, "W?rfel, hand made");
}

TEST_F(ImportDeck, DamagedDecksEndInAMessage)
{
  const std::string sound = std::string(two_cubes) + R"(*NSET, NSET=all, GENERATE
1, 18
*INITIAL CONDITIONS, TYPE=TEMPERATURE
all, 20.
*AMPLITUDE, NAME=wave, TIME=TOTAL TIME
0., 0., .5, 1., 1., -1.
*TIE, NAME=t, POSITION TOLERANCE=.1
above, below
*CLEARANCE, SLAVE=above, MASTER=below, VALUE=.001
*STEP, NLGEOM=NO
*STATIC
.25, 1.
*BOUNDARY, AMPLITUDE=wave
15, 1, 1, .1
16, 1, 1, .1
17, 1, 1, .1
18, 1, 1, .1
*CLOAD, OP=NEW
top, 3, 1.
*DLOAD
upper, P2, 1.
lower, GRAV, 9.81, 0., 0., -1.
upper, CENTRIF, 10., 0., 0., 0., 0., 0., 1.
*TEMPERATURE
all, 30.
*NODE PRINT, NSET=top
U
*END STEP
)";
  std::mt19937 random(5);
  int n_imported = 0;
  for (int k = 0; k < 2000; ++k)
  {
    const std::string text = test::damaged(sound, random);
    try
    {
      const ImportedDeck deck = import(text, std::set<std::string>{"BOUNDARY"});
      ++n_imported;
      static_cast<void>(config_of(deck));
    }
    catch (const InputError& error)
    {
      EXPECT_NE(error.problem(), "");
    }
  }
  EXPECT_GT(n_imported, 300);
}

TEST(Groups, AreCutIntoParts)
{
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial)
  {
    case_file::Groups groups;
    std::vector<std::set<Index>> given;
    for (int g = 0; g < 5; ++g)
    {
      std::set<Index> members;
      for (Index i = 0; i < 12; ++i)
        if (random() % 3 == 0) members.insert(i);
      if (members.empty()) continue;
      const int number = groups.add(fmt::format("g{}", g), {members.begin(), members.end()});
      if (number == static_cast<int>(given.size())) given.push_back(members);
    }
    std::vector<std::set<Index>> found(given.size());
    std::set<Index> all;
    std::set<std::string> names;
    for (const case_file::Groups::Part& part : groups.parts())
    {
      EXPECT_TRUE(names.insert(part.name).second);
      for (const Index member : part.members)
      {
        EXPECT_TRUE(all.insert(member).second);
        for (const int g : part.groups) found[g].insert(member);
      }
    }
    EXPECT_EQ(found, given);
  }
}

}  // namespace

}  // namespace tribound
