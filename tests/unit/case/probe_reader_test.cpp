/// @file probe_reader_test.cpp
/// [probe.NAME] and [section.NAME] in a case: what is read, and what a user is told.

#include "tribound/case/probe_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tribound/mesh/box.h"

namespace tribound::test
{
namespace
{

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

case_file::Config config_with(const std::string& text)
{
  return case_file::parse_config(
      "mesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }\nmaterial = { E = 1, nu = 0 }\n" + text);
}

io::Observations<2> observations_of(const std::string& text)
{
  return case_file::observations<2>(
      config_with(text),
      mesh::Mesh<2>(mesh::box_mesh<2>({.lower = {0, 0}, .upper = {2, 1}, .cells = {4, 2}, .where = {}})));
}

/// The complaint about a case on that mesh; empty where there is none.
std::string complaint(const std::string& text)
{
  try
  {
    (void)observations_of(text);
  }
  catch (const InputError& error)
  {
    return std::string(error.what());
  }
  return {};
}

TEST(ProbeReader, ReadsPointsAndLines)
{
  const io::Observations<2> read = observations_of(R"(
[probe.crest]
point = [2, 1]
[probe."a line"]
from = [0, 0.5]
to = [2, 1]
points = 5
)");
  ASSERT_EQ(read.probes.size(), 2u);
  EXPECT_EQ(read.probes[0].name, "crest");
  EXPECT_THAT(read.probes[0].points, ElementsAre(Point<2>(2, 1)));
  EXPECT_EQ(read.probes[1].name, "a line");
  EXPECT_THAT(read.probes[1].points, ElementsAre(Point<2>(0, 0.5), Point<2>(0.5, 0.625), Point<2>(1, 0.75),
                                                 Point<2>(1.5, 0.875), Point<2>(2, 1)));
}

TEST(ProbeReader, ReadsSections)
{
  const io::Observations<2> read = observations_of(R"(
[section.cut]
point = [1, 0]
normal = [3e200, 4e200]
[section.part]
point = [1, 0]
normal = [1, 0]
within = "0.6 - y"
)");
  ASSERT_EQ(read.sections.size(), 2u);
  EXPECT_EQ(read.sections[0].name, "cut");
  EXPECT_EQ(read.sections[0].point, Point<2>(1, 0));
  EXPECT_NEAR((read.sections[0].normal - Point<2>(0.6, 0.8)).norm(), 0, 1e-15);
  EXPECT_FALSE(read.sections[0].within);
  EXPECT_NEAR((*read.sections[1].within)(Point<2>(0, 0.5)), 0.1, 1e-15);
}

TEST(ProbeReader, TellsWhatIsWrongWithAProbe)
{
  EXPECT_THAT(complaint("[[probe]]\npoint = [1, 0]"), HasSubstr("[probe.crest]"));
  EXPECT_THAT(complaint("[probe.p]"),
              AllOf(HasSubstr("probe.p: has neither point nor from"), HasSubstr("points = 11")));
  EXPECT_THAT(complaint("[probe.p]\npoints = 3"), HasSubstr("has neither point nor from"));
  EXPECT_THAT(complaint("[probe.p]\npoint = [1, 0]\nfrom = [0, 0]"), HasSubstr("from"));
  EXPECT_THAT(complaint("[probe.p]\npoint = [1, 0]\npoints = 3"), HasSubstr("belongs to a line"));
  EXPECT_THAT(complaint("[probe.p]\nfrom = [1, 0]\npoints = 3"), HasSubstr("to"));
  EXPECT_THAT(complaint("[probe.p]\nfrom = [1, 0]\nto = [1, 1]"), HasSubstr("points"));
  EXPECT_THAT(complaint("[probe.p]\nfrom = [1, 0]\nto = [1, 1]\npoints = 1"),
              HasSubstr("both ends included"));
  EXPECT_THAT(complaint("[probe.p]\npoint = [1, 0, 0]"),
              AllOf(HasSubstr("probe.p.point"), HasSubstr("has 3 components, but the mesh is 2D")));
  EXPECT_THAT(complaint("[probe.p]\nfrom = [1, 0]\nto = [1, 1, 1]\npoints = 2"), HasSubstr("probe.p.to"));
  EXPECT_THAT(complaint("[probe.p]\npoint = [1, 1.5]"), HasSubstr("lies outside the mesh, 0.5 from it"));
  EXPECT_THAT(complaint("[probe.p]\nplace = [1, 0]"), HasSubstr("unknown key"));
}

TEST(ProbeReader, TellsWhatIsWrongWithASection)
{
  EXPECT_THAT(complaint("section = 1"), HasSubstr("[section.base]"));
  EXPECT_THAT(complaint("[section.s]\nnormal = [0, 1]"), HasSubstr("point"));
  EXPECT_THAT(complaint("[section.s]\npoint = [0, 1]"), HasSubstr("normal"));
  EXPECT_THAT(complaint("[section.s]\npoint = [0, 1]\nnormal = [0, 0]"), HasSubstr("no length"));
  EXPECT_THAT(complaint("[section.s]\npoint = [0, 1]\nnormal = [0, 0, 1]"), HasSubstr("section.s.normal"));
  EXPECT_THAT(complaint("[section.s]\npoint = [0, 5]\nnormal = [0, 1]"),
              AllOf(HasSubstr("section.s"), HasSubstr("cuts no cell")));
  const std::string good = "[section.s]\npoint = [1, 0]\nnormal = [1, 0]\nwithin = ";
  EXPECT_EQ(complaint(good + "\"y\""), "");
  EXPECT_THAT(complaint(good + "\"-y\""), HasSubstr("no part where within is positive"));
  EXPECT_THAT(complaint(good + "\"y - t\""), HasSubstr("contains the load factor t"));
  EXPECT_THAT(complaint(good + "\"z\""), HasSubstr("uses z in a 2D case"));
  EXPECT_THAT(complaint(good + "1"), HasSubstr("within"));
  EXPECT_THAT(complaint(good + "\"1/(y - y)\""), HasSubstr("within"));
}

}  // namespace
}  // namespace tribound::test
