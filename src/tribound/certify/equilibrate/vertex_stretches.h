#pragma once

/// @file vertex_stretches.h
/// Which thread solves which patches.

#include <span>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

/// The vertices whose patches are solved, in stretches, one for each thread.
struct VertexStretches
{
  std::vector<Index> order;         ///< of the vertices
  std::vector<std::size_t> begin;   ///< of the stretches in `order`
  std::vector<int> stretch;         ///< per vertex; -1 for one whose patch is left out
  std::vector<Index> shared_cells;  ///< with vertices in several stretches
  std::vector<int> shared_place;    ///< per cell: place in shared_cells, or -1

  [[nodiscard]] int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// Divides the vertices, sorted along a space-filling curve, into `n` stretches of equal length.
template <int dim>
[[nodiscard]] VertexStretches stretches_of(const mesh::Mesh<dim>& mesh, std::span<const Index> vertices,
                                           int n);

}  // namespace tribound::certify
