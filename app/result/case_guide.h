#pragma once

/// @file case_guide.h
/// What docs/case-format.md says of tables and keys, for those who do not read it there.

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
  std::map<std::string, KeyGuide> keys;  ///< by "table.key"; those of the case have no table
};

/// Reads the sections "## [name]" and in them the tables whose first column is "key", of the section, or
/// "key of `name`", of a table in it. Links lose where they lead to.
[[nodiscard]] CaseGuide read_case_guide(std::string_view markdown);

}  // namespace tribound::app
