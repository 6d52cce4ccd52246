#include "tribound/case/sweep_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.h"

namespace tribound
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;

case_file::SweepTable grid(const std::vector<std::string>& assignments)
{
  return case_file::sweep_grid(assignments);
}

using test::message_of;

TEST(SweepValues, RangesAreDecimal)
{
  EXPECT_THAT(grid({"a.b=0.1:0.8:8"}).rows,
              ElementsAre(ElementsAre("0.1"), ElementsAre("0.2"), ElementsAre("0.3"), ElementsAre("0.4"),
                          ElementsAre("0.5"), ElementsAre("0.6"), ElementsAre("0.7"), ElementsAre("0.8")));
  EXPECT_THAT(grid({"degree=1:3:3"}).rows, ElementsAre(ElementsAre("1"), ElementsAre("2"), ElementsAre("3")));
  EXPECT_THAT(grid({"t=1e-3:-1e-3:2"}).rows, ElementsAre(ElementsAre("0.001"), ElementsAre("-0.001")));
}

TEST(SweepValues, FirstKeyVariesSlowest)
{
  const case_file::SweepTable table = grid({"a=[1, 2]", "b=[\"x\", \"2*x\"]", "c=[0, -1.5]"});
  EXPECT_THAT(table.keys, ElementsAre("a", "b", "c"));
  ASSERT_EQ(table.rows.size(), 8u);
  EXPECT_THAT(table.rows[0], ElementsAre("1", "\"x\"", "0"));
  EXPECT_THAT(table.rows[1], ElementsAre("1", "\"x\"", "-1.5"));
  EXPECT_THAT(table.rows[2], ElementsAre("1", "\"2*x\"", "0"));
  EXPECT_THAT(table.rows[7], ElementsAre("2", "\"2*x\"", "-1.5"));
}

TEST(SweepValues, ArraysOfArraysSweepVectors)
{
  EXPECT_THAT(grid({"t=[[0, -1], [0, \"x\"]]"}).rows,
              ElementsAre(ElementsAre("[0, -1]"), ElementsAre("[0, \"x\"]")));
  EXPECT_THAT(grid({"solver.method=direct"}).rows, ElementsAre(ElementsAre("direct")));
}

TEST(SweepValues, MistakesAreNamed)
{
  EXPECT_THAT(message_of([] { return grid({"degree"}); }), HasSubstr("degree: there is no \"=\""));
  EXPECT_THAT(message_of([] { return grid({"a="}); }), HasSubstr("there is no value"));
  EXPECT_THAT(message_of([] { return grid({"a=[]"}); }), HasSubstr("there is no value"));
  EXPECT_THAT(message_of([] { return grid({"a=1:2:1"}); }), HasSubstr("cannot make 1 values from 1 to 2"));
  for (const std::string range : {"0.1.5:0.8:3", "1-2:3:4", "1e:2:3", "1:--2:3", "1:2:1e", "+-1:2:3"})
    EXPECT_THAT(message_of([&] { return grid({"a=" + range}); }),
                ::testing::AnyOf(HasSubstr("is no finite number"), HasSubstr("cannot make")))
        << range;
  EXPECT_THAT(message_of([] { return grid({"a=1:2:2.5"}); }),
              HasSubstr("cannot make 2.5 values from 1 to 2"));
  EXPECT_EQ(grid({"a=" + std::string(300000, '1') + ":x:1"}).rows.size(), 1U);  // a word, however long
  EXPECT_THAT(message_of([] { return grid({"a=[x, 2*x]"}); }), HasSubstr("stand in quotes"));
  EXPECT_THAT(message_of([] { return grid({"a=1", "a=2"}); }), HasSubstr("\"a\" is swept twice"));
  EXPECT_THAT(message_of(
                  [] {
                    return grid({"a=0:1:1000", "b=0:1:1000"});
                  }),
              HasSubstr("more than 100000 runs"));
}

TEST(SweepValues, TableHasARowPerRun)
{
  const case_file::SweepTable table = case_file::sweep_rows(
      "degree, boundary.top.pressure\r\n1,\"50*x\"\n\n2,\"max(x, \"\"y\"\")\"\n", "runs.csv");
  EXPECT_THAT(table.keys, ElementsAre("degree", "boundary.top.pressure"));
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("1", "50*x"), ElementsAre("2", "max(x, \"y\")")));
  EXPECT_THAT(message_of([] { return case_file::sweep_rows("a,b\n1\n", "runs.csv"); }),
              HasSubstr("runs.csv: run 1 has 1 values for 2 keys"));
  EXPECT_THAT(message_of([] { return case_file::sweep_rows("a,b\n1,\n", "runs.csv"); }),
              HasSubstr("run 1 has 1 values for 2 keys"));
  EXPECT_THAT(message_of([] { return case_file::sweep_rows("a\n", "runs.csv"); }),
              HasSubstr("runs.csv: holds no run"));
  EXPECT_THAT(message_of([] { return case_file::sweep_rows("a\n\"x\"y\n", "runs.csv"); }),
              HasSubstr("runs.csv:2: something follows the quote"));
  EXPECT_THAT(message_of([] { return case_file::sweep_rows("a\n1\n\"x\n2\n", "runs.csv"); }),
              HasSubstr("runs.csv:3: a quote is not closed"));
}

}  // namespace
}  // namespace tribound
