#pragma once

/// @file inp.h
/// Meshes from decks for Abaqus, CalculiX and PrePoMax.

#include <filesystem>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// Reads *NODE, *ELEMENT, *ELSET, *NSET, *SURFACE, *INCLUDE, *PART, *INSTANCE; passes over loads and the
/// like. Sets and surfaces of an instance are named "instance.set".
///
/// Regions: the sets of *SOLID SECTION, else those of *ELSET, else those of *ELEMENT, whichever first have
/// every element once; else the one set that has all. Boundaries: surfaces, sets of plane and shell elements
/// that are faces of solids, sets of trusses that are edges in 2D, and node sets (node_sets.h).
///
/// Throws InputError with file and line, or with the element: what is not read, missing, or given twice,
/// shells and beams, regions that are not clear. With `ignores_elements` shells, beams, springs and the like
/// are left out, and `notes` lists them.
[[nodiscard]] ImportedMesh read_inp(const std::filesystem::path& file, bool ignores_elements,
                                    std::vector<std::string>& notes);

/// The deck and all files that it includes, in the order in which they are read; as far as they can be read.
[[nodiscard]] std::vector<std::filesystem::path> files_of_inp(const std::filesystem::path& file);

}  // namespace tribound::mesh
