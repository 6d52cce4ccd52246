#pragma once

/// @file case_schema.h
/// `tribound schema`: the case format for editors.

#include <string>

namespace tribound::app
{

/// case_file::case_table() as a JSON Schema of draft 7, which TOML editors support, with descriptions from
/// docs/case-format.md. It accepts every valid case. Checks that need more than the case file, such as names
/// of a mesh, formulas and the dimension, are left to `tribound check`.
[[nodiscard]] std::string case_schema();

}  // namespace tribound::app
