#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tribound/case/config.h"

namespace tribound::override_cases
{
namespace
{

using testing::HasSubstr;

constexpr auto text = R"toml(
degree = 1
[mesh]
file = "a.msh"
[material]
E = 1
nu = 0.3
[boundary.bottom]
contact = { friction = "tresca", threshold = 0.03 }
[boundary.top]
traction = [0, -1]
)toml";

const Point<2> somewhere(2, 3);

case_file::Config with(const std::vector<std::string>& overrides)
{
  return case_file::parse_config(text, "case.toml", overrides);
}

TEST(Override, ReplacesAValue)
{
  EXPECT_EQ(with({"degree=3"}).method.degree, 3);
  EXPECT_EQ(with({"material.E = 2.5"}).materials[0].E, 2.5);
  EXPECT_EQ(with({"boundary.top.traction=[1, \"x\"]"}).boundaries[1].traction[1](somewhere), 2.0);
}

TEST(Override, AddsAKeyAndTheTablesAroundIt)
{
  const case_file::Config config =
      with({"adapt.tolerance=0.02", "boundary.left.displacement=[0, 'free']", "title=''"});
  EXPECT_EQ(config.adapt.tolerance, 0.02);
  ASSERT_EQ(config.boundaries.size(), 3u);
  EXPECT_EQ(config.boundaries[2].name, "left");
  EXPECT_EQ(config.title, "");
}

TEST(Override, ReachesIntoInlineTables)
{
  const case_file::Config config = with({"boundary.bottom.contact.threshold=0.5"});
  EXPECT_EQ(std::get<problem::Tresca>(config.boundaries[0].contact->law).threshold(somewhere), 0.5);
}

TEST(Override, ReplacesATable)
{
  const case_file::Config config = with({"boundary.bottom.contact={friction=\"coulomb\", coefficient=0.4}"});
  EXPECT_EQ(std::get<problem::Coulomb>(config.boundaries[0].contact->law).coefficient, 0.4);
}

TEST(Override, TakesABareWordAsAString)
{
  EXPECT_EQ(with({"solver.method=direct"}).method.solver.method, algebra::LinearMethod::direct);
  EXPECT_EQ(with({"title=a block = a cuboid"}).title, "a block = a cuboid");
  EXPECT_EQ(with({"output.directory=/tmp/out"}).output.directory, "/tmp/out");
  EXPECT_EQ(with({"boundary.right.pressure=10*max(0, 9-y)"}).boundaries[2].pressure.value()(somewhere), 60.0);
}

TEST(Override, ReachesIntoArrays)
{
  EXPECT_EQ(with({"boundary.top.traction.1=-0.5"}).boundaries[1].traction[1].constant(), -0.5);
  constexpr auto pairs =
      "mesh.file = 'a.msh'\nmaterial = {E = 1, nu = 0.3}\n[[contact]]\nslave = 'a'\nmaster = 'b'\n"
      "[[contact]]\nslave = 'c'\nmaster = 'd'\nfriction = 'coulomb'\ncoefficient = 0.1\n";
  const std::vector<std::string> overrides = {"contact.1.coefficient=0.4",
                                              "contact.0={slave='e', master='f'}"};
  const case_file::Config config = case_file::parse_config(pairs, "case", overrides);
  EXPECT_EQ(config.contacts[0].slave.front(), "e");
  EXPECT_EQ(std::get<problem::Coulomb>(config.contacts[1].contact.law).coefficient, 0.4);
}

TEST(Override, TakesQuotedNames)
{
  EXPECT_EQ(with({"boundary.\"a.b = c\".pressure=1"}).boundaries[2].name, "a.b = c");
}

TEST(Override, TheLastOneHolds)
{
  EXPECT_EQ(with({"degree=2", "degree=3"}).method.degree, 3);
}

struct BadOverride
{
  std::string assignment;
  std::string message;
  std::string hint;
};

class BadOverrides : public testing::TestWithParam<BadOverride>
{
};

TEST_P(BadOverrides, AreNamed)
{
  try
  {
    (void)with({GetParam().assignment});
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    EXPECT_EQ(std::string(error.what()).find("--set " + GetParam().assignment + ": " + GetParam().message),
              0u)
        << error.what();
    EXPECT_THAT(error.hint(), HasSubstr(GetParam().hint));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Override, BadOverrides,
    testing::Values(
        BadOverride{"degree=7", "degree: must be an integer from 1 to 4, found 7", "degree"},
        BadOverride{"adapt.tolerence=1", "adapt.tolerence: unknown key", "did you mean \"tolerance\"?"},
        BadOverride{"boundary.top.traction=[1]", "boundary.top.traction: must be an array of 2 or 3", ""},
        BadOverride{"boundary.top.traction=[1, true]", "boundary.top.traction[1]: must be a number", ""},
        BadOverride{"boundary.bottom.contact={friction=\"tresca\", threshold=-1}",
                    "boundary.bottom.contact.threshold: must not be negative", ""},
        BadOverride{"boundary.top.traction.2=1",
                    "boundary.top.traction.2: boundary.top.traction is an array of 2",
                    "boundary.top.traction.0 is the first item"},
        BadOverride{"boundary.top.traction.x=1",
                    "boundary.top.traction.x: boundary.top.traction is an array of 2", ""},
        BadOverride{"boundary.top.traction=[1, 2", "not valid TOML", "quotes"},
        BadOverride{"degree", "there is no \"=\"", "--set key=value"},
        BadOverride{"degree=", "there is no value", "\"\""},
        BadOverride{"=3", "\"\" is not a key", "dotted names"},
        BadOverride{"a b=3", "\"a b\" is not a key", "quoted"},
        BadOverride{"[newton]=3", "\"[newton]\" is not a key", "quoted"},
        BadOverride{"degree=2\ntitle='x'", "holds a line break", "one --set for each key"},
        BadOverride{"degree.p=2", "degree.p: degree is the integer 1, not a table", "whole key"},
        BadOverride{"mesh.box={lower=[0,0],upper=[1,1],cells=[1,1]}", "mesh.box: ", "one of them"}));

}  // namespace
}  // namespace tribound::override_cases
