#pragma once

/// @file node_hierarchy.h
/// Nested spaces on a mesh and its ancestors, as plain data for multigrid.

#include <span>
#include <vector>

#include "tribound/algebra/petsc.h"
#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"
#include "tribound/fem/space.h"

namespace tribound::algebra
{

/// Gives the values at the nodes of a space from those at the nodes of a subspace.
struct NodeInterpolation
{
  Index n_fine = 0;
  Index n_coarse = 0;
  Triplets weights;  ///< row: fine node, column: coarse node; nonzeros only, each once
  Sharing fine;      ///< on several ranks; numbers of nodes are local
  Sharing coarse;
};

/// Spaces from that of a matrix down to one that is small or left to aggregation. Degree of freedom
/// dim * node + component in all of them.
struct NodeHierarchy
{
  int dim = 0;
  std::vector<NodeInterpolation> steps;  ///< to each space from the next coarser one, the finest first
  /// Of the nodes of the coarsest space (own nodes on several ranks), [dim * node + component].
  std::vector<double> coarsest_coordinates;
  std::int64_t n_coarsest = 0;  ///< degrees of freedom of the coarsest space, of all ranks
};

/// A single space, of which only the positions of the nodes are known.
template <int dim>
[[nodiscard]] NodeHierarchy node_hierarchy(std::span<const Point<dim>> nodes);

/// P^p, P^q, ..., P^1 on the mesh of `space`, with q = p / 2 rounded up, then P^1 on its ancestors
/// (Mesh::ancestry). Each step goes to the next ancestor with at most two thirds of the vertices, as long as
/// there is one among the next three. All spaces together then cost at most three times the first. A mesh
/// that is shared out has no ancestors. All ranks call it together.
template <int dim>
[[nodiscard]] NodeHierarchy node_hierarchy(const fem::LagrangeSpace<dim>& space);

}  // namespace tribound::algebra
