#pragma once

/// @file gmsh_file.h
/// Meshes for Gmsh: adapted.msh.

#include <filesystem>
#include <span>
#include <string>

#include "tribound/mesh/mesh.h"

namespace tribound::io
{

/// Writes the mesh as a .msh (version 2.2, ASCII): regions and boundaries as physical groups by name, but the
/// boundaries `left_out`. read_gmsh() gives the same vertices, cells and groups. On several ranks, which call
/// it together, the first writes what the others tell it of their cells, a batch at a time: no rank needs
/// memory of the size of the mesh. Throws WriteError.
template <int dim>
void write_gmsh(const std::filesystem::path& file, const mesh::Mesh<dim>& mesh,
                std::span<const std::string> left_out = {});

}  // namespace tribound::io
