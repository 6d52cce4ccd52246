#pragma once

/// @file gmsh_text.h
/// Meshes for Gmsh.

#include <span>
#include <string>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// The mesh as a .msh file (version 2.2, ASCII): regions and boundaries as physical groups by name, but the
/// boundaries `left_out`. read_gmsh() gives the same vertices, cells and groups.
template <int dim>
[[nodiscard]] std::string gmsh_text(const Mesh<dim>& mesh, std::span<const std::string> left_out = {});

}  // namespace tribound::mesh
