#pragma once

/// @file vertex_partition.h
/// Which thread solves which patches.

#include <span>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

/// The vertices whose patches are solved, in parts, one for each thread.
struct VertexPartition
{
  std::vector<Index> order;         ///< of the vertices
  std::vector<std::size_t> begin;   ///< of the parts in `order`
  std::vector<int> part;            ///< per vertex; -1 for one whose patch is left out
  std::vector<Index> shared_cells;  ///< with vertices in several parts
  std::vector<int> shared_index;    ///< per cell: index in shared_cells, or -1

  [[nodiscard]] int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// Divides the vertices, sorted along a space-filling curve, into `n` parts of equal size.
template <int dim>
[[nodiscard]] VertexPartition partition_vertices(const mesh::Mesh<dim>& mesh, std::span<const Index> vertices,
                                                 int n);

}  // namespace tribound::certify
