#pragma once

/// @file imported_msh.h
/// Imported meshes for Gmsh, with the elements they came with.

#include <filesystem>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::io
{

/// Writes the mesh as a .msh (version 2.2, ASCII), completely or not at all: elements of all types with their
/// nodes of second order; sets of cells and of facets as named physical groups. Nodes and elements are
/// numbered anew in their order, nodes without an element are left out. mesh::read_mesh() makes the same
/// simplicial mesh of it. Where elements have both orders, which Gmsh does not keep, corners alone are
/// written. Node sets must have become facet sets (mesh::add_node_sets()). Throws WriteError, and InputError
/// for a name that the format cannot hold.
void write_msh(const std::filesystem::path& file, const mesh::ImportedMesh& mesh);

}  // namespace tribound::io
