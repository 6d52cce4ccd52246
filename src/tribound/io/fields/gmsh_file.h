#pragma once

/// @file gmsh_file.h
/// Meshes for Gmsh: adapted.msh.

#include <filesystem>
#include <span>
#include <string>

#include "tribound/mesh/mesh.h"

namespace tribound::io
{

/// Writes the mesh as a .msh (version 2.2, ASCII), with regions and boundaries as named physical groups,
/// except the boundaries `left_out`. read_mesh() returns the same vertices, cells and groups. All ranks call
/// it together. The first one writes the cells received from the others in batches, so no rank needs memory
/// of the size of the mesh. Throws WriteError.
template <int dim>
void write_gmsh(const std::filesystem::path& file, const mesh::Mesh<dim>& mesh,
                std::span<const std::string> left_out = {});

}  // namespace tribound::io
