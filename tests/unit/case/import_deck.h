#pragma once

/// @file import_deck.h
/// Imports decks of two cubes that touch.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tribound/case/config.h"
#include "tribound/case/deck/import_deck.h"

namespace tribound::test
{

/// Two cubes of one element each, the upper one on the lower one; nodes 1 to 8 and 11 to 18.
inline constexpr std::string_view two_cubes = R"(*HEADING
Two cubes, hand made
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=lower
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=upper
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=base
1, 2, 3, 4
*NSET, NSET=top
15, 16, 17, 18
*SURFACE, NAME=below
lower, S2
*SURFACE, NAME=above
upper, S1
*SURFACE, NAME=crown
upper, S2
*MATERIAL, NAME=steel
*ELASTIC
210000., .3
*DENSITY
7.8E-9
*EXPANSION
1.2E-5
*SOLID SECTION, ELSET=lower, MATERIAL=steel
*SOLID SECTION, ELSET=upper, MATERIAL=steel
*SURFACE INTERACTION, NAME=touch
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1.E6
*FRICTION
.3, 1.E5
*CONTACT PAIR, INTERACTION=touch, TYPE=NODE TO SURFACE
above, below
*BOUNDARY
base, 1, 3
)";

inline constexpr std::string_view one_step = "*STEP\n*STATIC\n1., 1.\n";

class ImportDeck : public testing::Test
{
 protected:
  void SetUp() override { std::filesystem::create_directories(directory_); }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  case_file::ImportedDeck import(std::string_view text, const std::set<std::string>& accepted = {})
  {
    std::ofstream(directory_ / "deck.inp") << text;
    return case_file::import_deck(directory_ / "deck.inp", "deck.msh", accepted);
  }
  /// The two cubes with more model data, and a step of 1 with these loads.
  case_file::ImportedDeck import(std::string_view model, std::string_view loads,
                                 const std::set<std::string>& accepted = {})
  {
    return import(fmt::format("{}{}{}{}*END STEP\n", two_cubes, model, one_step, loads), accepted);
  }
  static case_file::Config config_of(const case_file::ImportedDeck& deck)
  {
    return case_file::parse_config(deck.case_text, "deck.toml");
  }
  static const case_file::BoundaryConfig& boundary(const case_file::Config& config, const std::string& name)
  {
    const auto found = std::ranges::find(config.boundaries, name, &case_file::BoundaryConfig::name);
    if (found == config.boundaries.end()) throw std::runtime_error("no boundary " + name);
    return *found;
  }
  static double value(const problem::Field& field, double t, const Point<3>& x = Point<3>::Zero())
  {
    return field.at(t)(x);
  }

  std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() / fmt::format("tribound_import_{}", getpid());
};

}  // namespace tribound::test
