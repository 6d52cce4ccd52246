#pragma once

/// @file generalized_eigen.h
/// Generalised eigenvalue problems of small dense matrices.

#include "tribound/base/dense_factors.h"

namespace tribound::test
{

/// A x = lambda B x, both symmetric, B positive definite: lambda in ascending order, and x with x^T B x = 1,
/// column by column.
inline SymmetricEigen generalized_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  // B = L L^T: the eigenvalues are those of L^{-1} A L^{-T}, whose vectors are L^T x
  const Eigen::MatrixXd lower = CholeskyFactors(b).lower();
  const Eigen::MatrixXd half = solve_lower(lower, a).transpose();
  const SymmetricEigen eigen = symmetric_eigen(solve_lower(lower, half));
  return {eigen.values, solve_lower_transposed(lower, eigen.vectors)};
}

}  // namespace tribound::test
