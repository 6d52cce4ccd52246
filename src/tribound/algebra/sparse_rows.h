#pragma once

/// @file sparse_rows.h
/// Sums of sparse matrices as plain data.

#include <span>
#include <vector>

#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"

namespace tribound::algebra
{

/// The pattern of n rows of entries, with values 0. `places`: of each entry in it, -1 of those that do not
/// count.
[[nodiscard]] SparseRows pattern_of(Index n, const Triplets& entries, std::vector<int>& places);

/// a + b, whose pattern is the union of theirs.
[[nodiscard]] SparseRows sum(const SparseRows& a, const SparseRows& b);

/// The same again with other values, into what sum(a, b) has returned.
void assign_sum(const SparseRows& a, const SparseRows& b, SparseRows& result);

}  // namespace tribound::algebra
