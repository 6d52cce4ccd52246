#pragma once

/// @file cad_unit.h
/// In which unit a CAD file has its lengths.

#include <filesystem>
#include <string>

namespace tribound::mesh
{

/// The unit of length of a STEP or IGES file, by the name that Open CASCADE has for it: "MM", "M", "INCH",
/// ... Empty: the file names none, several, or another one.
[[nodiscard]] std::string length_unit(const std::filesystem::path& file);

}  // namespace tribound::mesh
