#pragma once

/// @file imported_bytes.h
/// Imported meshes and solutions, and why there is none, as strings of bytes between processes of the same
/// program.

#include <string>
#include <string_view>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/import/imported_solution.h"

namespace tribound::mesh
{

/// All of a mesh but its source, and what is to be said of it.
[[nodiscard]] std::string bytes_of(const ImportedMesh& mesh, const std::vector<std::string>& notes = {});
[[nodiscard]] std::string bytes_of(const ImportedSolution& solution);
[[nodiscard]] std::string bytes_of(const InputError& error);

/// The mesh again, with `source`; the notes are appended. Throws the InputError if it is one.
[[nodiscard]] ImportedMesh mesh_from(std::string_view bytes, const Where& source,
                                     std::vector<std::string>& notes);

/// The solution again.
[[nodiscard]] ImportedSolution solution_from(std::string_view bytes, const Where& source);

}  // namespace tribound::mesh
