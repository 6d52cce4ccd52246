#pragma once

/// @file gmsh_load.h
/// What gmsh.cpp runs in a process of its own: reading a file, or meshing it, by Gmsh's library.

#include <filesystem>
#include <variant>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Reads a .msh or meshes a .geo, group by group. Throws InputError, and what Gmsh throws; may also crash or
/// hang where Gmsh does.
[[nodiscard]] std::variant<MeshData<2>, MeshData<3>> load_gmsh(const std::filesystem::path& file);

}  // namespace tribound::mesh
