#pragma once

/// @file gmsh_load.h
/// A file read or meshed by Gmsh's library, in a process of its own.

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// Reads a mesh or meshes a geometry, group by group; see read_gmsh(). Throws InputError, and what Gmsh
/// throws; may also crash or hang where Gmsh does.
[[nodiscard]] ImportedMesh load_gmsh(const MeshFile& source, std::vector<std::string>& notes);

/// What `load`, which uses Gmsh, returns in a copy of this process: see read_gmsh(). An InputError that it
/// throws is returned as bytes (import/imported_bytes.h).
[[nodiscard]] std::string load_apart(const std::filesystem::path& file,
                                     const std::function<std::string()>& load, const std::atomic<bool>* stop,
                                     double patience);

}  // namespace tribound::mesh
