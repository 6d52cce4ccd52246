#pragma once

/// @file vtk.h
/// Meshes from unstructured grids of VTK.

#include <filesystem>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// Reads a .vtu, a .pvtu with its parts, or a .vtk. Cells and points are numbered from 0, through all pieces.
///
/// Regions: the values of a cell array of integers, "3"; the array `region_array`, or else, if it is empty,
/// the first of usual names that the file has; without one a single region. Boundaries: the cells of one
/// dimension less by the same array, those with 0 left out. Points of different pieces are one where
/// they have the same global number; ghost cells are left out.
///
/// `notes` gets what was left out, and how many points of a region coincide. Throws InputError with the file
/// and the number of the cell: what is not read or damaged, an unknown array.
[[nodiscard]] ImportedMesh read_vtk(const std::filesystem::path& file, const std::string& region_array,
                                    std::vector<std::string>& notes);

}  // namespace tribound::mesh
