// The tables of docs/case-format.md against the program: keys, words and ranges cannot drift apart.
//
// The type of a key decides how it is tried out; see try_out().

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tribound/case/config.h"
#include "unit/case/case_format.h"

namespace tribound::test
{
namespace
{

bool belongs_to_slider(const Row& row)
{
  return row.table == "boundary.top" && (row.key == "normal" || row.key == "shape");
}

/// Other settings that a key needs to be allowed.
std::vector<std::string> companions(const Row& row)
{
  if (row.table == "material.NAME")
    return {"material.NAME.E=1", "material.NAME.nu=0",
            row.key == "of" ? "material.NAME.where=\"x < 1\"" : "degree=1"};
  if (row.key == "of") return {row.table + ".where=\"x < 1\""};
  if (row.key == "threshold") return {row.table + ".friction=tresca"};
  if (row.key == "reference_degree") return {"degree=1"};
  if (row.name() == "obstacle.o.translate") return {"obstacle.o.distance=\"y\""};
  if (row.key == "reference_temperature") return {"load.temperature=1"};
  if (row.key == "side") return {row.table + ".surface=a.stl"};
  if (row.name() == "shape.o.translate") return {"shape.o.circle={centre=[0,0],radius=1}"};
  if (row.key == "damage_step")
    return {"boundary.top.interface={law=\"joint\",tensile_strength=1,fracture_energy=1}",
            "history.steps=[0,1]", "history.control=\"damage\""};
  if (row.name() == "quantity.0.point" || row.name() == "quantity.0.ramp")
    return {"quantity.0.kind=contact_moment"};
  if (row.table == "probe.o" && row.key != "point")
  {
    std::vector<std::string> line = {"probe.o.from=[0, 0]", "probe.o.to=[1, 0]", "probe.o.points=5"};
    std::erase_if(line, [&](const std::string& key) { return key.starts_with(row.name() + "="); });
    return line;
  }
  if (row.key == "goal_tolerance") return {"quantity=[{kind=\"energy\"}]", "adapt.goal=energy"};
  if (belongs_to_slider(row)) return {"boundary.top.slider=0"};
  if (row.name() == "boundary.top.spring.rest") return {"boundary.top.spring.normal=1"};
  if (row.key == "coefficient") return {row.table + ".friction=coulomb"};
  if (row.name() == "parameters.NAME.value") return {"material.E=\"1 + NAME^2\""};
  if (row.table == "parameters.NAME") return {"parameters.NAME.value=1", "material.E=NAME"};
  return {};
}

/// The error for "key = value" in its place, or nothing if it is accepted.
std::optional<InputError> refusal(const Row& row, const std::string& value)
{
  std::vector<std::string> overrides = {row.name() + "=" + value};
  if (row.name() == "mesh.file" || row.name() == "boundary.top.contact") overrides.clear();
  for (const std::string& companion : companions(row)) overrides.push_back(companion);
  std::string text = valid_case(row.table);
  if (row.name() == "mesh.file") text = "mesh.file = " + value + "\nmaterial = { E = 1, nu = 0 }\n";
  const std::set<std::string> options = {"size", "merge", "ignore_elements", "region_array", "boundaries"};
  if (row.table == "mesh" && options.contains(row.key))
    text = "mesh.file = \"a.msh\"\nmaterial = { E = 1, nu = 0 }\n";
  if (row.name() == "boundary.top.contact") text = valid_case("") + "boundary.top.contact = " + value + "\n";
  if (row.name() == "boundary.top.slider" || belongs_to_slider(row)) text = valid_case("");
  if (row.name() == "contact.0.joint") text = valid_case("") + "contact = [{}]\n";
  try
  {
    (void)case_file::parse_config(text, "case", overrides);
    return {};
  }
  catch (const InputError& error)
  {
    return error;
  }
}

void expect_accepted(const Row& row, const std::string& value)
{
  const std::optional<InputError> error = refusal(row, value);
  EXPECT_FALSE(error) << row.name() << " = " << value << ", documented as \"" << row.type
                      << "\": " << error->what();
}

void expect_refused(const Row& row, const std::string& value)
{
  EXPECT_TRUE(refusal(row, value)) << row.name() << " = " << value << " is accepted, documented as \""
                                   << row.type << '"';
}

/// The words of "`"a"`, `"b"`" must be those that the program lists.
void try_out_words(const Row& row)
{
  const std::vector<std::string> words = quoted(row.type, "\"");
  const std::optional<InputError> error = refusal(row, "\"no such word\"");
  ASSERT_TRUE(error) << row.name();
  EXPECT_THAT(quoted(error->hint(), "\""), testing::ElementsAreArray(words)) << row.name();
}

/// "number > 0", "number in (-1, 0.5)", "integer >= 1", "integer 1 to 4": the ends and values beyond them.
void try_out_numbers(const Row& row)
{
  std::smatch match;
  const bool integer = row.type.starts_with("integer");
  const std::string step = integer ? "1" : "1e-9";
  const auto beyond = [&](const std::string& end, int sign)
  { return fmt::format("{}", std::stod(end) + sign * std::stod(step)); };
  const auto end_point = [&](const std::string& end, bool included, int outward)
  {
    included ? expect_accepted(row, end) : expect_refused(row, end);
    expect_refused(row, beyond(end, outward));
    if (!integer) expect_accepted(row, beyond(end, -outward));
  };
  if (std::regex_match(row.type, match,
                       std::regex("(?:number|datum|integer) (>=?) ([-0-9.]+)(?:, or table)?")))
  {
    end_point(match[2], match[1] == ">=", -1);
    expect_accepted(row, "1000");
  }
  else if (std::regex_match(row.type, match, std::regex("number in ([[(])([-0-9.]+), ([-0-9.]+)([\\])])")))
  {
    end_point(match[2], match[1] == "[", -1);
    end_point(match[3], match[4] == "]", 1);
  }
  else if (std::regex_match(row.type, match, std::regex("integer ([0-9]+) to ([0-9]+)")))
  {
    end_point(match[1], true, -1);
    end_point(match[2], true, 1);
  }
  else if (row.type == "number")
  {
    expect_accepted(row, "-2.5");
    expect_refused(row, "inf");
  }
  else
    FAIL() << row.name() << ": the type \"" << row.type << "\" is not known here";
  if (integer) expect_refused(row, "1.5");
  if (!row.type.starts_with("datum")) expect_refused(row, "\"1 + x - x\"");
}

/// Tries values that the documented type allows and values that it does not.
void try_out(const Row& row)
{
  if (row.type.starts_with("as of")) return;
  expect_refused(row, "1979-05-27");
  if (row.type.starts_with("`\""))
    try_out_words(row);
  else if (row.type.starts_with("true"))
  {
    expect_accepted(row, "true");
    expect_accepted(row, "false");
    expect_refused(row, "1");
  }
  else if (row.type.starts_with("string"))
  {
    expect_accepted(row, "\"some words\"");
    expect_refused(row, "1");
    if (row.type.find("not empty") != std::string::npos) expect_refused(row, "\"\"");
  }
  else if (row.type.starts_with("vector"))
  {
    expect_accepted(row, "[0, \"x - x\"]");
    expect_refused(row, "0");
    const bool has_free = row.type.find("\"free\"") != std::string::npos;
    has_free ? expect_accepted(row, "[0, \"free\"]") : expect_refused(row, "[0, \"free\"]");
  }
  else if (row.type == "datum" || row.type.starts_with("datum, or"))
  {
    for (const std::string& word : quoted(row.type, "\"")) expect_accepted(row, "\"" + word + "\"");
    expect_accepted(row, "\"2*x\"");
    expect_accepted(row, "-1");
    expect_refused(row, "[1, 2]");
  }
  else if (row.type.starts_with("array of numbers"))
  {
    expect_accepted(row, "[0, 1.5, -1]");
    expect_refused(row, "[]");
    expect_refused(row, "1");
  }
  else if (row.type == "array of texts")
  {
    expect_accepted(row, "[\"some words\", \"others\"]");
    expect_refused(row, "[1]");
    expect_refused(row, "\"words\"");
  }
  else if (row.type == "array of data")
  {
    expect_accepted(row, "[0, \"x\", -1]");
    expect_refused(row, "[1, 2]");
    expect_refused(row, "1");
  }
  else if (row.type == "array of names")
  {
    expect_accepted(row, "[\"a\", \"b\"]");
    expect_refused(row, "[]");
    expect_refused(row, "[1]");
    expect_refused(row, "\"a\"");
  }
  else if (row.type.starts_with("array of `"))
  {
    for (const std::string& word : quoted(row.type, "\"")) expect_accepted(row, "[\"" + word + "\"]");
    expect_refused(row, "[\"no such word\"]");
    expect_refused(row, "[]");
  }
  else if (row.type == "table")
    expect_refused(row, "1");
  else if (row.type.starts_with("name"))
  {
    expect_refused(row, "1");
    expect_refused(row, "\"no such name\"");
  }
  else if (row.type == "formula")
  {
    expect_accepted(row, "\"x - 2*y\"");
    expect_refused(row, "\"2*q\"");
    expect_refused(row, "1");
  }
  else if (row.type.starts_with("2 or 3"))
  {
    for (const std::string& word : quoted(row.type, "\"")) expect_accepted(row, "\"" + word + "\"");
    expect_refused(row, "[1]");
  }
  else
    try_out_numbers(row);
}

TEST(CaseFormat, TypesAndRangesAreThoseOfTheProgram)
{
  for (const Row& row : documented_keys()) try_out(row);
}

/// The keys of a table that the program lists when it meets an unknown key.
std::set<std::string> allowed_keys(const std::string& table)
{
  const std::optional<InputError> error = refusal({table, "zzzz", "", ""}, "0");
  if (!error || error->problem() != "unknown key") return {};
  const std::string marker = "allowed here: ";
  std::string list = error->hint().substr(error->hint().find(marker) + marker.size());
  list = list.substr(0, list.find(", or tables"));
  std::set<std::string> keys;
  std::istringstream stream(list);
  for (std::string key; std::getline(stream, key, ',');) keys.insert(key.substr(key.find_first_not_of(' ')));
  return keys;
}

TEST(CaseFormat, KeysAreThoseOfTheProgram)
{
  std::map<std::string, std::set<std::string>> documented;
  for (const Row& row : documented_keys())
  {
    documented[row.table].insert(row.key);
    if (row.table.find('.') == std::string::npos && !row.table.empty()) documented[""].insert(row.table);
  }
  documented[""].insert(
      {"boundary", "contact", "obstacle", "parameters", "probe", "quantity", "section", "shape"});
  for (const auto& [table, keys] : documented) EXPECT_EQ(keys, allowed_keys(table)) << "[" << table << "]";
}

TEST(CaseFormat, TheTablesWereFound)
{
  const std::vector<Row> rows = documented_keys();
  EXPECT_GE(rows.size(), 40u);
  EXPECT_EQ(std::ranges::count_if(rows, [](const Row& row) { return row.table == "mesh.box"; }), 3);
}

}  // namespace
}  // namespace tribound::test
