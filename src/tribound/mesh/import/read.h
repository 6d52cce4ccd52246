#pragma once

/// @file read.h
/// Meshes from files of all formats: one way from the file to the simplicial mesh.

#include <atomic>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "tribound/mesh/formula_groups.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/import/simplices.h"
#include "tribound/mesh/mesh.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

using AnyMesh = std::variant<Mesh<2>, Mesh<3>>;

/// Reads the mesh of a file as it stands there, by the suffix of its name, with what the options ask for; or
/// meshes a geometry. `notes` gets what was left out: "part.msh: ...". Throws InputError, at source.where for
/// a file that is not there, not read, or has no use for an option; SolveError once `stop` is true.
[[nodiscard]] ImportedMesh read_imported(const MeshFile& source, const std::atomic<bool>* stop,
                                         double patience, std::vector<std::string>& notes);

/// The mesh that a case asks for: read, made simplicial, with its groups, cut open, verified. An .stl, whose
/// volume has to be filled first, is refused.
[[nodiscard]] AnyMesh read_mesh(const MeshSource& source, const FindSeams& find_seams = {},
                                const std::atomic<bool>* stop = nullptr,
                                std::vector<std::string>* notes = nullptr,
                                std::span<const FormulaGroup> groups = {});

/// A file that meshes are read from, a deck with those that it includes. Files that a .geo or a .pvtu names
/// are not among them.
[[nodiscard]] std::vector<std::filesystem::path> with_included(const std::filesystem::path& file);

}  // namespace tribound::mesh
