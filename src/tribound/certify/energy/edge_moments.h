#pragma once

/// @file edge_moments.h
/// What balances the cells of a solution of degree 1: moments along edges, distributed to the cells around
/// them.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

/// K_{T,a}: d + 1 skew tensors for each cell, for its vertices in ascending order, with
///     K_{T,a} = sum_{b in T, b != a} (sum_{T' contains ab} w_{T'})^{-1} q_ab,
///     q_ab(W) = R(psi_a psi_b W (b - a)),    w_T(W, W') = (W (x - x_T), W' (x - x_T))_T for skew W, W'.
/// They add up to 0 on every cell, sum_T w_T(K_{T,a}, W) = R(psi_a W (x - a)), and all vanish if R does.
/// `forces`, per edge of the topology, is R(psi_a psi_b e_i), 0 in the components that Gamma_D fixes on the
/// edge; arbitrary for edges without a vertex that has a patch on this rank.
template <int dim>
[[nodiscard]] std::vector<Tensor<dim>> edge_moments(const mesh::Mesh<dim>& mesh,
                                                    std::span<const Point<dim>> forces);

}  // namespace tribound::certify
