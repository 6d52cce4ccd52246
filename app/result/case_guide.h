#pragma once

/// @file case_guide.h
/// The descriptions of tables and keys in docs/case-format.md, for use elsewhere.

#include <map>
#include <string>
#include <string_view>

namespace tribound::app
{

/// A row of a table of keys.
struct KeyGuide
{
  std::string standard;  ///< the column "default"; empty where there is none
  std::string meaning;
};

struct CaseGuide
{
  std::map<std::string, std::string>
      tables;                            ///< the first sentence of each section, by the name of its table
  std::map<std::string, KeyGuide> keys;  ///< by "table.key"; top-level keys have no table
};

/// Reads the sections "## [name]". In them it reads the tables whose first column is "key", for the section,
/// or "key of `name`", for a subtable. Links lose their targets.
[[nodiscard]] CaseGuide read_case_guide(std::string_view markdown);

}  // namespace tribound::app
