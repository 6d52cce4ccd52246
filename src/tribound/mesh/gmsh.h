#pragma once

/// @file gmsh.h
/// Meshes and geometries in the formats that Gmsh's own library reads.

#include <atomic>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// s.
inline constexpr double default_patience = 300;

/// Reads a .msh of any version (ASCII, binary), .unv, .bdf; or meshes a .geo, .step, .brep, .iges, .stl, with
/// edges of at most options.size. Cells are the elements of the highest dimension.
///
/// Names: physical groups of dimension dim are regions, of dimension dim-1 boundaries; without physical
/// groups of dimension dim everything is one region. Of a .bdf, properties by their numbers. Of a CAD
/// geometry, which is meshed to order 2, solids ("solid1") are regions and faces ("face1") boundaries, by
/// their labels where they have any; faces between two solids get no name.
///
/// Gmsh works in a copy of this process (base/apart.h). Whatever it does with a file (crash, hang, use up
/// memory), the result is an InputError. It is given up after `patience` seconds without a sign of progress,
/// or as soon as `stop` is true, which ends in a SolveError. Gmsh's state in this process is not touched.
/// `notes` gets what the user did not ask for, in words.
[[nodiscard]] ImportedMesh read_gmsh(const MeshFile& source, const std::atomic<bool>* stop, double patience,
                                     std::vector<std::string>& notes);

/// The version of Gmsh's library.
[[nodiscard]] std::string gmsh_version();

}  // namespace tribound::mesh
