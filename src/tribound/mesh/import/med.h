#pragma once

/// @file med.h
/// Meshes from Salome's files.

#include <filesystem>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// Reads the mesh of a .med of the versions 2.2 to 4 (HDF5), which has one mesh of one time.
///
/// Regions: the groups of cells, if they have every cell once (groups that have all cells do not count beside
/// others); else the first that has all; without groups a single region. Boundaries: the groups of
/// elements of one dimension less, and the groups of nodes (node_sets.h).
///
/// HDF5 does not survive damaged files: it works in a copy of this process.
///
/// Throws InputError with the file, and the number of the element: what is not read, missing or damaged,
/// regions that are not clear, faces of no cell.
[[nodiscard]] ImportedMesh read_med(const std::filesystem::path& file);

/// The mesh alone, whatever its groups are.
[[nodiscard]] ImportedMesh read_med_without_groups(const std::filesystem::path& file);

}  // namespace tribound::mesh
