#pragma once

/// @file bdf_check.h
/// What a Nastran deck has that Gmsh passes over without a word.

#include <filesystem>
#include <string>
#include <vector>

namespace tribound::mesh
{

/// Throws InputError with the line: nodes in a coordinate system of their own, INCLUDE, and elements that are
/// neither solids nor plane (beams, springs, masses, rigid ones), unless they are to be ignored; then `notes`
/// counts them.
void check_bdf(const std::filesystem::path& file, bool ignores_elements, std::vector<std::string>& notes);

}  // namespace tribound::mesh
