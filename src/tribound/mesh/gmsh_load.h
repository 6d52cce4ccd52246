#pragma once

/// @file gmsh_load.h
/// The part of gmsh.cpp that runs in a process of its own: reads or meshes a file by Gmsh's library.

#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// Reads a mesh or meshes a geometry, group by group; see read_gmsh(). Throws InputError, and what Gmsh
/// throws; may also crash or hang where Gmsh does.
[[nodiscard]] ImportedMesh load_gmsh(const MeshFile& source, std::vector<std::string>& notes);

}  // namespace tribound::mesh
