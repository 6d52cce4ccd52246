#pragma once

/// @file case_schema.h
/// `tribound schema`: the case format for editors.

#include <string>

namespace tribound::app
{

/// case_file::case_table() as a JSON Schema of draft 7, which the editors of TOML know, described by
/// docs/case-format.md. It accepts every valid case; what takes more than the case file to tell, such as
/// names of a mesh, formulas and the dimension, is left to `tribound check`.
[[nodiscard]] std::string case_schema();

}  // namespace tribound::app
