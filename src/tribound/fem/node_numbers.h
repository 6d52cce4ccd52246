#pragma once

/// @file node_numbers.h
/// Numbers of the nodes of a space on a mesh that is shared out between ranks.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tribound/base/ghost_update.h"
#include "tribound/base/ranks.h"
#include "tribound/base/types.h"
#include "tribound/mesh/mesh.h"

namespace tribound::fem
{

/// A node belongs to the lowest of the ranks with own cells around it. That rank has all cells of the node,
/// ghosts included, so that its rows of a matrix are complete; between bodies after contact::with_partners().
struct NodeNumbers
{
  Ranks ranks;
  std::vector<Index> owned;          ///< local numbers, ascending
  std::vector<std::int64_t> global;  ///< per local node: those of the first rank first, then of the second
  std::int64_t first = 0;            ///< global number of the first own node
  std::int64_t n = 0;                ///< of all ranks
  GhostUpdate update;                ///< from a node's owner to the others that have it
};

/// `cell_nodes`: local nodes, n_cell_nodes for each cell; a node has the same place in a cell on every rank.
/// Null for a whole mesh. All ranks call it together.
template <int dim>
[[nodiscard]] std::shared_ptr<const NodeNumbers> number_nodes(const mesh::Mesh<dim>& mesh, Index n_nodes,
                                                              std::span<const Index> cell_nodes,
                                                              int n_cell_nodes);

}  // namespace tribound::fem
