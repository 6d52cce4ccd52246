// The program reads the examples of docs/case-format.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tribound/case/config.h"

namespace tribound
{
namespace
{

std::vector<std::string> toml_blocks(const std::string& file)
{
  std::ifstream stream(file);
  std::vector<std::string> blocks;
  bool inside = false;
  for (std::string line; std::getline(stream, line);)
  {
    if (line == "```toml") blocks.emplace_back();
    if (line.starts_with("```"))
      inside = line == "```toml";
    else if (inside)
      blocks.back() += line + "\n";
  }
  return blocks;
}

TEST(Documentation, EveryExampleIsAValidCase)
{
  const std::vector<std::string> blocks = toml_blocks(TRIBOUND_DOCS "/case-format.md");
  EXPECT_GE(blocks.size(), 10u);
  for (std::string block : blocks)
  {
    if (block.find("[mesh]") == std::string::npos) block += "[mesh]\nfile = 'a.msh'\n";
    if (block.find("[material]") == std::string::npos) block += "[material]\nE = 1\nnu = 0\n";
    EXPECT_NO_THROW((void)case_file::parse_config(block)) << block;
  }
}

/// The cells of a line of a table, without surrounding spaces.
std::vector<std::string> cells_of(const std::string& line)
{
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');)
  {
    const auto first = cell.find_first_not_of(' ');
    cells.push_back(first == std::string::npos ? ""
                                               : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
  }
  return cells;
}

std::vector<std::string> lines_of(const std::string& file)
{
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Documentation, KindsOfUnitsAreThoseOfTheProgram)
{
  std::vector<std::string> documented;
  for (const std::string& line : lines_of(TRIBOUND_DOCS "/output.md"))
  {
    if (!documented.empty() && !line.starts_with("|")) break;
    if (line.starts_with("| kind, key of `units`") || (!documented.empty() && line.starts_with("| `")))
      documented.push_back(line);
  }
  ASSERT_EQ(documented.size(), problem::unit_names.size() + 2);  // with the head, and the quantities
  for (std::size_t i = 0; i < problem::unit_names.size(); ++i)
  {
    const auto& [name, what] = problem::unit_names[i];
    const std::vector<std::string> cells = cells_of(documented[i + 1]);
    const problem::Units units("mm", "N");
    EXPECT_EQ(cells[0], "`" + std::string(name) + "`");
    EXPECT_EQ(cells[2], units.label(what, 2)) << name;
    EXPECT_EQ(cells[3], units.label(what, 3)) << name;
  }
}

TEST(Documentation, EveryColumnHasAKnownKindOfUnit)
{
  std::set<std::string> known = {"", "s", "of the quantity", "energy_norm;"};
  for (const auto& [name, what] : problem::unit_names) known.insert(name);
  int n_columns = 0;
  std::size_t place = 0;  // of the column "unit" in the current table
  for (const std::string& line : lines_of(TRIBOUND_DOCS "/output.md"))
  {
    const std::vector<std::string> cells =
        line.starts_with("|") ? cells_of(line) : std::vector<std::string>();
    if (cells.empty()) place = 0;
    const auto head = std::ranges::find(cells, "unit");
    if (head != cells.end())
      place = static_cast<std::size_t>(head - cells.begin());
    else if (place > 0 && !line.starts_with("|---"))
    {
      EXPECT_TRUE(known.contains(cells[place])) << line;
      ++n_columns;
    }
  }
  EXPECT_GE(n_columns, 60);
}

TEST(Documentation, StressesOfTheUnitsAreThoseOfTheProgram)
{
  int n_rows = 0;
  for (const std::string& line : lines_of(TRIBOUND_DOCS "/case-format.md"))
  {
    const std::vector<std::string> cells =
        line.starts_with("|") ? cells_of(line) : std::vector<std::string>();
    if (cells.size() != 4 || cells[0].find(", ") == std::string::npos || cells[0].front() == '`') continue;
    const std::size_t comma = cells[0].find(", ");
    const problem::Units units(cells[0].substr(0, comma), cells[0].substr(comma + 2));
    EXPECT_EQ(cells[1], units.label(problem::UnitOf::stress)) << line;
    EXPECT_EQ(cells[2], units.label(problem::UnitOf::body_force)) << line;
    const std::size_t second = cells[3].find(", ");
    EXPECT_NEAR(std::stod(cells[3].substr(0, second)) * units.pascals() / 208.5e9, 1, 0.01) << line;
    EXPECT_NEAR(std::stod(cells[3].substr(second + 2)) * units.pascals() / units.metres() / 77e3, 1, 0.01)
        << line;
    ++n_rows;
  }
  EXPECT_EQ(n_rows, 7);
}

}  // namespace
}  // namespace tribound
