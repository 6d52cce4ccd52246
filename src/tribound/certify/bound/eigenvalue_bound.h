#pragma once

/// @file eigenvalue_bound.h
/// Guaranteed lower bounds of the smallest eigenvalue of sparse matrices, for the Friedrichs constant.

#include <vector>

#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"

namespace tribound::certify
{

/// A and M for the facet means that are not fixed, with the same sparsity pattern.
struct Pencil
{
  Index n = 0;
  std::vector<Index> number;  ///< of each facet, -1 where fixed
  algebra::Triplets a;
  std::vector<double> m;  ///< the values of M
};

/// A theta for which A - theta M is proved to be positive definite, as close below the smallest eigenvalue as
/// possible; 0 if there is none. The proof needs only the factorisation, not the eigenvalue.
[[nodiscard]] double proved_theta(Pencil pencil, int dim);

}  // namespace tribound::certify
