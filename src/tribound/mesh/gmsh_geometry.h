#pragma once

/// @file gmsh_geometry.h
/// Geometries that Gmsh meshes: its own scripts, CAD, surfaces of triangles.

#include <filesystem>
#include <string>
#include <vector>

#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// Whether the file, by its suffix, is a geometry, not a mesh.
[[nodiscard]] bool is_geometry(const std::filesystem::path& file);
/// Whether its solids and faces are the groups: CAD, or a surface of triangles.
[[nodiscard]] bool has_named_entities(const std::filesystem::path& file);

/// Opens and meshes a geometry in the Gmsh that runs: CAD to order 2, with the middles of edges on its
/// surfaces, in the unit of length of the file. Edges are at most options.size; without it, those of a script
/// as it says, others by the extent of the geometry, with a note. Throws InputError and what Gmsh throws.
void mesh_geometry(const MeshFile& source, std::vector<std::string>& notes);

}  // namespace tribound::mesh
