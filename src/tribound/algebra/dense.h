#pragma once

/// @file dense.h
/// Dense matrices, column by column, by BLAS and LAPACK.

#include <cstddef>
#include <span>
#include <vector>

namespace tribound::algebra::detail
{

/// y += a A x for a matrix of the given shape, or with its transpose.
void add_product(double a, std::span<const double> matrix, std::size_t rows, std::size_t columns,
                 bool transposed, std::span<const double> x, std::span<double> y);

/// Solves M d = r up to `tolerance` (absolute, Euclidean) or round-off, by LU factors; `m` is M^T. Throws
/// SolveError for a singular tangent when M is singular to working precision.
[[nodiscard]] std::vector<double> solve_dense(const std::vector<double>& m, std::span<const double> r,
                                              double tolerance);

}  // namespace tribound::algebra::detail
