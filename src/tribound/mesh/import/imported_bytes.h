#pragma once

/// @file imported_bytes.h
/// Imported meshes, and why there is none, as strings of bytes between processes of the same program.

#include <string>
#include <string_view>

#include "tribound/base/error.h"
#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// All of a mesh but its source.
[[nodiscard]] std::string bytes_of(const ImportedMesh& mesh);
[[nodiscard]] std::string bytes_of(const InputError& error);

/// The mesh again; throws the InputError if it is one.
[[nodiscard]] ImportedMesh mesh_from(std::string_view bytes);

}  // namespace tribound::mesh
