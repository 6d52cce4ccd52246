/// @file quantity_test.cpp
/// [[quantity]] in a case: what is read, and what a user is told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/case/config.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/resolve.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

/// A block on a floor with friction, plus the given text of a case file.
case_file::Config config(const std::string& text)
{
  return case_file::parse_config(R"(
mesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
material = { E = 1, nu = 0.3 }
boundary.left.displacement = [0, 0]
boundary.bottom.contact = { friction = "coulomb", coefficient = 0.5 }
)" + text);
}

std::string message(const std::string& text)
{
  return message_of([&] { return config(text); });
}

const std::vector<std::string> sides = {"left", "right", "bottom", "top"};

std::vector<problem::Quantity<2>> on_mesh(const case_file::Config& c)
{
  const std::vector<std::string> regions = {"box"};
  return case_file::resolve_quantities<2>(c, case_file::resolve<2>(c, regions, sides), sides);
}

std::string message_on_mesh(const std::string& quantity)
{
  const case_file::Config c = config("[[quantity]]\n" + quantity);
  return message_of([&] { return on_mesh(c); });
}

TEST(QuantityReader, ReadsWhatIsWanted)
{
  const case_file::Config c = config(R"(
[[quantity]]
kind = "energy"
[[quantity]]
name = "thrust"
kind = "contact_force"
boundary = "bottom"
direction = [0, 2]
ramp = 0.25
[[quantity]]
kind = "contact_moment"
point = [1, 0.5]
[[quantity]]
kind = "mean_displacement"
boundary = "right"
)");
  const auto quantities = on_mesh(c);
  ASSERT_EQ(quantities.size(), 4u);
  EXPECT_EQ(quantities[0].name, "energy");
  EXPECT_EQ(quantities[1].name, "thrust");
  EXPECT_EQ(quantities[1].direction.value(), Point<2>(0, 2));
  EXPECT_EQ(quantities[1].ramp, 0.25);
  EXPECT_EQ(quantities[2].point.value(), Point<2>(1, 0.5));
  EXPECT_EQ(quantities[3].name, "mean_displacement right");
  EXPECT_FALSE(quantities[3].direction);
  EXPECT_EQ(c.adapt.bars.levels, adapt::EnergyLevels::last);
}

TEST(QuantityReader, AGoalNeedsTheBoundOnEveryMesh)
{
  const std::string energy = "[[quantity]]\nkind = \"energy\"\n";
  EXPECT_EQ(config(energy + "[adapt]\ngoal = \"energy\"").adapt.bars.levels, adapt::EnergyLevels::every);
  EXPECT_EQ(config("[adapt]\nmeasure = \"energy\"").adapt.bars.levels, adapt::EnergyLevels::every);
  EXPECT_EQ(config("[adapt]\nenergy_tolerance = 0.1").adapt.bars.levels, adapt::EnergyLevels::every);
  EXPECT_THAT(message(energy + "[adapt]\ngoal = \"energy\"\n[certify]\nenergy = \"last\""),
              HasSubstr("certify.energy: is the string \"last\""));
  EXPECT_THAT(message(energy + "[certify]\nenergy = \"off\""), HasSubstr("there is a [[quantity]]"));
  EXPECT_THAT(message(energy + "[adapt]\ngoal = \"energie\""), HasSubstr("one of \"energy\""));
  EXPECT_THAT(message("[adapt]\ngoal = \"energy\""), HasSubstr("is no [[quantity]]"));
  EXPECT_THAT(message(energy + "[adapt]\ngoal_tolerance = 0.1"), HasSubstr("without a goal"));
}

TEST(QuantityReader, LoadStepsHaveThemButAreNotSteered)
{
  const std::string steps = "[history]\nsteps = [1, 2]\n";
  EXPECT_EQ(config(steps).adapt.bars.levels, adapt::EnergyLevels::last);
  EXPECT_EQ(config("[[quantity]]\nkind = \"energy\"\n" + steps).quantities.size(), 1);
  EXPECT_EQ(config("[certify]\nenergy = \"off\"\n" + steps).adapt.bars.levels, adapt::EnergyLevels::off);
  for (const char* const adapt : {"measure = \"energy\"", "energy_tolerance = 0.1"})
    EXPECT_THAT(message("[adapt]\n" + std::string(adapt) + "\n" + steps),
                HasSubstr("the bound of the residual refines meshes of load steps"));
}

TEST(QuantityReader, SaysWhatIsWrong)
{
  EXPECT_THAT(message("quantity = 1"), HasSubstr("an array of tables"));
  EXPECT_THAT(message("[[quantity]]\nkind = \"force\""), HasSubstr("\"contact_force\""));
  EXPECT_THAT(message("[[quantity]]\nkind = \"energy\"\ndirection = [0, 1]"), HasSubstr("direction"));
  EXPECT_THAT(message("[[quantity]]\nkind = \"contact_force\""), HasSubstr("direction"));
  EXPECT_THAT(message("[[quantity]]\nkind = \"contact_force\"\ndirection = \"normal\""),
              HasSubstr("without a boundary"));
  EXPECT_THAT(message("[[quantity]]\nkind = \"contact_force\"\ndirection = [0, 0]"), HasSubstr("no length"));
  EXPECT_THAT(message("[[quantity]]\nkind = \"mean_displacement\""), HasSubstr("boundary"));
  EXPECT_THAT(message("[[quantity]]\nkind = \"energy\"\n[[quantity]]\nkind = \"energy\""),
              HasSubstr("the name of another one"));
  EXPECT_THAT(message_on_mesh("kind = \"mean_displacement\"\nboundary = \"rihgt\""),
              HasSubstr("did you mean \"right\""));
  EXPECT_THAT(message_on_mesh("kind = \"contact_force\"\nboundary = \"top\""), HasSubstr("no contact"));
  EXPECT_THAT(message_on_mesh("kind = \"safety_factor\"\nboundary = \"top\""),
              HasSubstr("no Coulomb friction"));
  EXPECT_THAT(message_on_mesh("kind = \"contact_force\"\ndirection = [0, 1, 0]"), HasSubstr("2D"));
}

}  // namespace

}  // namespace tribound::test
