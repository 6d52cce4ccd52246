// The keys that the program declares, against the tables of docs/case-format.md. The readers and
// `tribound schema` use these keys.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tribound/case/keys.h"
#include "unit/case/case_format.h"

namespace tribound::test
{
namespace
{

using case_file::Interval;
using case_file::Key;
using case_file::Table;
using case_file::Value;

/// All tables by name. Tables of one name have the same keys, except for those that a boundary adds to an
/// interface.
void collect(const Table& table, std::map<std::string, std::map<std::string, Value>>& tables)
{
  const auto look_into = [&](const auto& self, const Value& value) -> void
  {
    if (value.table != nullptr) collect(*value.table, tables);
    for (const Value& item : value.items) self(self, item);
  };
  for (const Key& key : table.keys)
  {
    tables[table.name].insert({key.name, key.value});
    look_into(look_into, key.value);
  }
  if (table.named) look_into(look_into, *table.named);
}

std::map<std::string, std::map<std::string, Value>> declared()
{
  std::map<std::string, std::map<std::string, Value>> tables;
  collect(case_file::case_table(), tables);
  return tables;
}

/// The program's name of a documented table.
std::string declared_name(const std::string& documented)
{
  static const std::map<std::string, std::string> names = {{"boundary.top", "boundary.NAME"},
                                                           {"boundary.top.contact", "boundary.NAME.contact"},
                                                           {"boundary.top.spring", "boundary.NAME.spring"},
                                                           {"boundary.top.rigid", "boundary.NAME.rigid"},
                                                           {"contact.0", "contact"},
                                                           {"quantity.0", "quantity"},
                                                           {"obstacle.o", "obstacle.NAME"},
                                                           {"obstacle.o.plane", "obstacle.NAME.plane"},
                                                           {"obstacle.o.circle", "obstacle.NAME.circle"},
                                                           {"obstacle.o.cylinder", "obstacle.NAME.cylinder"},
                                                           {"shape.o", "shape.NAME"},
                                                           {"probe.o", "probe.NAME"},
                                                           {"section.o", "section.NAME"}};
  const auto found = names.find(documented);
  return found == names.end() ? documented : found->second;
}

/// "number > 0", "datum >= 0", "number in (-1, 0.5)", "integer 1 to 4", "integer >= 1".
Interval documented_interval(const std::string& type)
{
  std::smatch match;
  if (std::regex_search(type, match, std::regex("in ([[(])([-0-9.]+), ([-0-9.]+)([\\])])")))
    return {std::stod(match[2]), std::stod(match[3]), match[1] == "[", match[4] == "]"};
  if (std::regex_search(type, match, std::regex("integer ([0-9]+) to ([0-9]+)")))
    return {std::stod(match[1]), std::stod(match[2]), true, true};
  if (std::regex_search(type, match, std::regex("(?:number|datum|integer) (>=?) ([-0-9.]+)")))
    return {.lower = std::stod(match[2]), .includes_lower = match[1] == ">="};
  return {};
}

void expect_interval(const Row& row, const Interval& declared)
{
  Interval documented = documented_interval(row.type);
  // The limits that keep squares finite are not documented for each key.
  if (row.type.starts_with("datum"))
  {
    documented.upper = case_file::reasonable.upper;
    documented.includes_upper = true;
    if (documented.lower < 0) documented = {-documented.upper, documented.upper, true, true};
  }
  EXPECT_EQ(declared.lower, documented.lower) << row.name();
  EXPECT_EQ(declared.upper, documented.upper) << row.name();
  EXPECT_EQ(declared.includes_lower, documented.includes_lower || std::isinf(declared.lower)) << row.name();
  EXPECT_EQ(declared.includes_upper, documented.includes_upper || declared.includes_upper) << row.name();
}

/// The declared forms must be exactly those of the documented type.
void expect_type(const Row& row, const Value& value)
{
  const auto names = [&](const char* words) { return std::regex_search(row.type, std::regex(words)); };
  if (row.type.starts_with("as of")) return;
  std::vector<std::string> words = value.words;
  for (const Value& item : value.items) words.insert(words.end(), item.words.begin(), item.words.end());
  EXPECT_THAT(words, testing::UnorderedElementsAreArray(quoted(row.type, "\""))) << row.name();
  EXPECT_EQ(value.truth, names("^true")) << row.name();
  EXPECT_EQ(value.table != nullptr, names("table|\\{")) << row.name();
  EXPECT_EQ(!value.items.empty(), names("^vector|numbers|integers|array")) << row.name();
  EXPECT_EQ(value.text, names("^datum|string|^name|formula")) << row.name();
  EXPECT_EQ(value.number.has_value(), names("^datum|number( |$)|^integer ")) << row.name();
  EXPECT_EQ(value.is_integer, names("^integer ")) << row.name();
  const bool needs_text = value.text && value.items.empty() && value.least > 0;
  EXPECT_EQ(needs_text, names("not empty") || row.name() == "mesh.file") << row.name();
  if (value.number) expect_interval(row, *value.number);
}

TEST(Keys, AreThoseOfTheDocumentation)
{
  std::map<std::string, std::set<std::string>> documented;
  for (const Row& row : all_documented_keys()) documented[declared_name(row.table)].insert(row.key);
  // Sections are the tables of the case. Short tables are documented with their key, and a region has the
  // keys of all.
  for (const auto& [name, keys] : declared())
  {
    if (name.empty() || !documented.contains(name)) continue;
    std::set<std::string> names;
    for (const auto& [key, value] : keys) names.insert(key);
    EXPECT_EQ(names, documented[name]) << "[" << name << "]";
  }
  std::vector<std::string> others;
  for (const auto& [name, keys] : declared())
    if (!documented.contains(name)) others.push_back(name);
  EXPECT_THAT(others, testing::ElementsAre("contact.shape", "history.steps", "history.stop", "history.then"));
  for (const auto& [name, keys] : documented) EXPECT_TRUE(declared().contains(name)) << "[" << name << "]";
}

TEST(Keys, TakeWhatIsDocumented)
{
  const auto tables = declared();
  for (const Row& row : all_documented_keys())
    expect_type(row, tables.at(declared_name(row.table)).at(row.key));
}

}  // namespace
}  // namespace tribound::test
