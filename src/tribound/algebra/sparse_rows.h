#pragma once

/// @file sparse_rows.h
/// Sums of sparse matrices as plain data.

#include <cstddef>
#include <span>
#include <vector>

#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"

namespace tribound::algebra
{

/// SparseRows and PETSc count the entries of a process with 32 bits. Throws SolveError if there are more.
void require_countable(std::size_t n_entries);

/// The pattern of `entries` as n rows, with values 0. `places`: the position of each entry in it, -1 for
/// those that do not count.
[[nodiscard]] SparseRows pattern_of(Index n, const Triplets& entries, std::vector<int>& places);

/// a + b, whose pattern is the union of theirs.
[[nodiscard]] SparseRows sum(const SparseRows& a, const SparseRows& b);

/// The same for other values of b, stored in a result of sum(a, b). Rows in which b has no entries stay as
/// they are.
void assign_sum(const SparseRows& a, const SparseRows& b, SparseRows& result);

}  // namespace tribound::algebra
