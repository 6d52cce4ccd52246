#pragma once

/// @file gmsh.h
/// Meshes from files, through Gmsh's own library.

#include <atomic>
#include <string>
#include <variant>
#include <vector>

#include "tribound/mesh/mesh.h"
#include "tribound/mesh/source.h"

namespace tribound::mesh
{

/// s.
inline constexpr double default_patience = 300;

using AnyMesh = std::variant<Mesh<2>, Mesh<3>>;

/// Reads any .msh version (ASCII, binary) or meshes a .geo. The dimension is that of the cells (2D needs z =
/// 0). Physical groups of dimension dim are regions, of dimension dim-1 boundaries; without physical groups
/// of dimension dim everything is one region. Elements may be all of element_type.h, of one order.
///
/// Gmsh works in a copy of this process (base/apart.h). Whatever it does with a file (crash, hang, use up
/// memory), the result is an InputError. It is given up after `patience` seconds without a sign of progress,
/// or as soon as `stop` is true, which ends in a SolveError. Gmsh's state in this process is not touched.
/// `notes` gets what was left out, in words.
[[nodiscard]] AnyMesh read_gmsh(const MeshFile& source, const FindSeams& seams = {},
                                const std::atomic<bool>* stop = nullptr, double patience = default_patience,
                                std::vector<std::string>* notes = nullptr);

/// The version of Gmsh's library.
[[nodiscard]] std::string gmsh_version();

/// The mesh that a case asks for; `stop` and `notes` as above.
[[nodiscard]] AnyMesh read_mesh(const MeshSource& source, const FindSeams& seams = {},
                                const std::atomic<bool>* stop = nullptr,
                                std::vector<std::string>* notes = nullptr);

}  // namespace tribound::mesh
