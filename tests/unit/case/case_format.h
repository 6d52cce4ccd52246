#pragma once

/// @file case_format.h
/// The tables of docs/case-format.md, and cases to try their keys in. The first column must be "key" (keys of
/// the section) or "key of `...`" (keys of the table of that name in the section).

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace tribound::test
{

/// A documented key.
struct Row
{
  std::string table;  ///< dotted; empty for the top level
  std::string key;
  std::string type;
  std::string standard;  ///< the column "default"; empty where there is none

  [[nodiscard]] std::string name() const { return table.empty() ? key : table + "." + key; }
};

inline std::vector<std::string> split_cells(const std::string& line)
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

/// The words in quotes: with backquotes, "`lower`, `upper`" gives lower and upper.
inline std::vector<std::string> quoted(const std::string& text, const std::string& quote)
{
  const std::regex pattern(quote + "([^" + quote + "]*)" + quote);
  std::vector<std::string> words;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    words.push_back((*it)[1]);
  return words;
}

/// The table that a section describes. "## [boundary.NAME]" is tried out on the boundary "top",
/// "## [[contact]]" on the first contact, obstacles, shapes, probes and sections on one called "o".
inline std::string section_table(const std::string& heading)
{
  const auto open = heading.find('[');
  if (open == std::string::npos) return {};
  if (heading.substr(open, 2) == "[[") return heading.substr(open + 2, heading.find(']') - open - 2) + ".0";
  const std::string table = heading.substr(open + 1, heading.find(']') - open - 1);
  for (const char* named : {"obstacle.NAME", "shape.NAME", "probe.NAME", "section.NAME"})
    if (table == named) return table.substr(0, table.find('.')) + ".o";
  return table == "boundary.NAME" ? "boundary.top" : table;
}

/// All documented keys. Those of an interface, which has no section of its own, are in the table "interface".
inline std::vector<Row> all_documented_keys()
{
  std::ifstream stream(TRIBOUND_DOCS "/case-format.md");
  std::vector<Row> rows;
  std::string section, table;
  std::vector<std::string> columns;
  for (std::string line; std::getline(stream, line);)
  {
    if (line.starts_with("## ")) section = section_table(line);
    if (!line.starts_with("|"))
    {
      columns.clear();
      continue;
    }
    const std::vector<std::string> cells = split_cells(line);
    if (columns.empty())
    {
      columns = cells;
      const std::vector<std::string> inner = quoted(columns[0], "`");
      table = inner.empty() ? section : (section.empty() ? "" : section + ".") + inner[0];
      continue;
    }
    if (!columns[0].starts_with("key") || line.starts_with("|---")) continue;
    const auto standard = std::ranges::find(columns, "default") - columns.begin();
    // The valid case has degree 1: replaces `degree` as a lower limit.
    const std::string type = std::regex_replace(cells[1], std::regex("from `degree` "), "1 ");
    for (const std::string& key : quoted(cells[0], "`"))
      rows.push_back({table, key, type, standard < std::ssize(columns) ? cells[standard] : ""});
  }
  return rows;
}

/// The documented keys of sections. Keys of an interface depend on each other and cannot be tried one by one.
inline std::vector<Row> documented_keys()
{
  std::vector<Row> rows = all_documented_keys();
  std::erase_if(rows, [](const Row& row)
                { return row.table == "interface" || row.table == "water" || row.table == "drain"; });
  return rows;
}

/// A valid case. The boundary "top" has contact only when its keys are tried out.
inline std::string valid_case(const std::string& table)
{
  std::string text =
      "mesh.box = { lower = [0, 0], upper = [1, 1], cells = [1, 1] }\nmaterial = { E = 1, nu = 0 }\n";
  if (table.starts_with("load")) text += "load.body = [0, 0]\n";
  if (table == "boundary.top") text += "boundary.top.traction = [0, 0]\n";
  if (table == "history") text += "history.steps = [1]\n";
  if (table == "units") text += "units = { length = 'mm', force = 'N' }\n";
  if (table == "regularisation") text += "regularisation = {}\n";
  if (table == "boundary.top.contact") text += "boundary.top.contact = {}\n";
  if (table.starts_with("obstacle.o")) text += "boundary.top.contact.obstacle = 'o'\n";
  if (table.starts_with("shape.o")) text += "boundary.top.contact = { shape = 'o', normal = 'facet' }\n";
  if (table == "obstacle.o.plane") text += "obstacle.o.plane = { point = [0, 0], normal = [0, 1] }\n";
  if (table == "obstacle.o.circle") text += "obstacle.o.circle = { centre = [0, 0], radius = 1 }\n";
  if (table == "obstacle.o.cylinder")
    text += "obstacle.o.cylinder = { centre = [0, 0, 0], axis = [0, 0, 1], radius = 1 }\n";
  if (table == "section.o") text += "section.o = { point = [0, 0], normal = [0, 1] }\n";
  if (table == "contact.0") text += "contact = [{slave = 'a', master = 'b'}]\n";
  if (table == "quantity.0") text += "quantity = [{kind = 'mean_displacement', boundary = 'top'}]\n";
  return text;
}

}  // namespace tribound::test
