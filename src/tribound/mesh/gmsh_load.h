#pragma once

/// @file gmsh_load.h
/// The part of gmsh.cpp that runs in a process of its own: reads or meshes a file by Gmsh's library.

#include <filesystem>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// Reads a .msh or meshes a .geo, group by group. Throws InputError, and what Gmsh throws; may also crash or
/// hang where Gmsh does.
[[nodiscard]] ImportedMesh load_gmsh(const std::filesystem::path& file);

}  // namespace tribound::mesh
