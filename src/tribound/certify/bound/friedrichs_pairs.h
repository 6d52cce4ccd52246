#pragma once

/// @file friedrichs_pairs.h
/// What contact between bodies contributes to the Friedrichs constant: a body that only others hold has one,
/// too.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

/// Numbers with
///     ||grad v||^2 + sum_k (1/h_k) ||[v]||_k^2
///         >= sum_T w_T ||grad v||_T^2 + sum_k c_k (mean_F(v^s) - mean_G(v^m))^2      for all v in H^1,
/// k the segments of all pairs, each between a slave facet F and a master facet G.
struct PairTerms
{
  struct Coupling
  {
    Index slave;    ///< number of the facet in the topology
    Index master;   ///< the same
    double weight;  ///< c_k
  };

  std::vector<double> cells;  ///< w_T, from 1/2 to 1
  std::vector<Coupling> couplings;
};

/// For the segments of the mesh, with h_k `facet_scale` times its value on this mesh. The mean of [v] over k
/// differs from that of the facet means by at most the differences of v from these, ||v - mean_F(v)||_F <=
/// C_{T,F} ||grad v||_T; this uses up a part of the gradients. From (a + b)^2 >= a^2/2 - b^2, t in (0, 1],
/// and at most m_G segments over one point of G:
///     w_T = 1 - 2 t sum_{F in T} C_{T,F}^2 m_F max_{k in F} (s_k / h_k),      c_k = t |k| / (2 h_k),
/// s_k = 1 on slaves, |k| / |Pi(k)| on masters.
template <int dim>
[[nodiscard]] PairTerms pair_terms(const mesh::Mesh<dim>& mesh,
                                   std::span<const contact::ContactSegment<dim>> segments,
                                   double facet_scale);

}  // namespace tribound::certify
