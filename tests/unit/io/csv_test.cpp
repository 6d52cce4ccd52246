#include "tribound/io/file/csv.h"

#include <gtest/gtest.h>

namespace tribound
{
namespace
{

TEST(CsvTable, QuotesWhatWouldBreakARow)
{
  io::CsvTable table("name,value");
  table.add("left, \"lower\"");
  table.add(0.1);
  table.end_row();
  EXPECT_EQ(table.text(), "name,value\n\"left, \"\"lower\"\"\",0.1\n");
}

TEST(CsvTable, ZeroHasNoSign)
{
  io::CsvTable table("a,b,c");
  table.add(-0.0);
  table.add(-1e-300);
  table.add(std::optional<double>{});
  table.end_row();
  EXPECT_EQ(table.text(), "a,b,c\n0,-1e-300,\n");
}

}  // namespace
}  // namespace tribound
