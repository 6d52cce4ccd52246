#pragma once

/// @file gmsh.h
/// Meshes from files, through Gmsh's own library.

#include <string>
#include <variant>

#include "case/config.h"
#include "mesh/mesh.h"

namespace tribound
{

using AnyMesh = std::variant<Mesh<2>, Mesh<3>>;

/// Reads any .msh version (ASCII, binary) or meshes a .geo. The dimension is that of the cells (2D needs z =
/// 0). Physical groups of dimension dim are regions, of dimension dim-1 boundaries; without physical groups
/// of dimension dim everything is one region. Throws InputError.
[[nodiscard]] AnyMesh read_gmsh(const MeshFile& source);

/// The version of Gmsh's library.
[[nodiscard]] std::string gmsh_version();

/// The mesh a case asks for.
[[nodiscard]] AnyMesh read_mesh(const MeshSource& source);

}  // namespace tribound
