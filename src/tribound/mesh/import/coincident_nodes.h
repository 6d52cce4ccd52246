#pragma once

/// @file coincident_nodes.h
/// Nodes at the same place, as programs write that give each cell its own.

#include <cstddef>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// The number of nodes of cells that lie exactly where another node of a cell of the same region lies.
[[nodiscard]] std::size_t n_coincident(const ImportedMesh& mesh);

}  // namespace tribound::mesh
