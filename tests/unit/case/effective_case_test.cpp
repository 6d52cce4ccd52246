// The case with every --set, as TOML that gives the same values when read again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "tribound/case/config.h"
#include "tribound/case/node.h"

namespace tribound
{
namespace
{

bool same(const case_file::Node& a, const case_file::Node& b);

bool same(const case_file::Node::Array& a, const case_file::Node::Array& b)
{
  return std::ranges::equal(a, b,
                            [](const case_file::Node& x, const case_file::Node& y) { return same(x, y); });
}

/// Equality up to the order of keys.
bool same(const case_file::Node::Table& a, const case_file::Node::Table& b)
{
  return a.size() == b.size() && std::ranges::all_of(a,
                                                     [&](const case_file::Entry& x)
                                                     {
                                                       const case_file::Entry* y = case_file::find(b, x.name);
                                                       return y != nullptr && same(x.node, y->node);
                                                     });
}

/// 1e5 may come back as 100000.
double number(const case_file::Node& node)
{
  const auto* integer = std::get_if<std::int64_t>(&node.value);
  return integer ? static_cast<double>(*integer) : std::get<double>(node.value);
}

bool same(const case_file::Node& a, const case_file::Node& b)
{
  if (std::holds_alternative<double>(a.value)) return number(a) == number(b);
  return a.value.index() == b.value.index() &&
         std::visit(
             [&](const auto& value)
             {
               using Value = std::decay_t<decltype(value)>;
               const Value& other = std::get<Value>(b.value);
               if constexpr (std::is_same_v<Value, case_file::Node::Table> ||
                             std::is_same_v<Value, case_file::Node::Array>)
                 return same(value, other);
               else if constexpr (std::is_same_v<Value, case_file::Node::DateOrTime> ||
                                  std::is_same_v<Value, problem::FieldFunction>)  // not in a text
                 return true;
               else
                 return value == other;
             },
             a.value);
}

constexpr auto awkward = R"toml(
degree = 2
"a key \" with \\ quotes" = "a\u0000b\n\t\"c\" \\ ü"
[numbers]
e = [1e5, -0.1, 1e300, 5e-324, 3, 1_000, 0x10, 0.1]
[empty]
[deep.down."two words".inline]
x = { y = { z = [true, [], [{ a = 1 }, {}]] } }
)toml";

TEST(EffectiveCase, TomlIsReadAgain)
{
  const case_file::Node document = case_file::parse_toml(awkward, "case");
  const std::string text = case_file::to_toml(document);
  EXPECT_TRUE(same(document, case_file::parse_toml(text, "again"))) << text;
  EXPECT_EQ(case_file::to_toml(case_file::parse_toml(text, "again")), text);
}

constexpr auto box = R"toml(
[material]
E = 210e9
nu = 0.3
[mesh]
box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }
[boundary.top]
traction = [0, "-1/3 * x"]
)toml";

TEST(EffectiveCase, HoldsWhatWasSetAndWhereResultsGo)
{
  const std::vector<std::string> overrides = {"degree=3", "material.E=1"};
  const case_file::Config config = case_file::parse_config(box, "block.toml", overrides);
  EXPECT_EQ(config.effective.text,
            "degree = 3\n\n[material]\nE = 1\nnu = 0.3\n\n[mesh.box]\nlower = [0, 0]\nupper = [2, 1]\n"
            "cells = [4, 2]\n\n[boundary.top]\ntraction = [0, \"-1/3 * x\"]\n\n[output]\n"
            "directory = \"out/block\"\n");
  EXPECT_THAT(config.effective.overrides, testing::ElementsAre("degree=3", "material.E=1"));
}

/// Read in its place, the effective case gives the same values, and so does its own effective case.
TEST(EffectiveCase, PathsAreValidFromTheOutputDirectory)
{
  constexpr auto with_files =
      "mesh.file = \"meshes/a.msh\"\nmaterial = { E = 1, nu = 0 }\n"
      "boundary.b.contact = { obstacle = \"die\", shape = \"part\" }\n"
      "obstacle.die.surface = \"surfaces/die.stl\"\nshape.part.surface = \"/parts/part.stl\"\n";
  for (const std::string directory : {"out/run", "/tmp/somewhere/else"})
  {
    const std::vector<std::string> overrides = {"output.directory=" + directory};
    const case_file::Config config = case_file::parse_config(with_files, "cases/block.toml", overrides);
    const case_file::Config again = case_file::parse_config(config.effective.text, directory + "/case.toml");
    const auto place = [](const std::filesystem::path& path)
    { return std::filesystem::absolute(path).lexically_normal(); };
    EXPECT_EQ(place(std::get<mesh::MeshFile>(again.mesh).path), place("cases/meshes/a.msh"));
    EXPECT_EQ(place(again.obstacles.at(0).file), place("cases/surfaces/die.stl"));
    EXPECT_EQ(place(again.shapes.at(0).file), "/parts/part.stl");
    EXPECT_EQ(again.output.directory, directory);
    EXPECT_EQ(again.effective.text, config.effective.text);
  }
}

}  // namespace
}  // namespace tribound
