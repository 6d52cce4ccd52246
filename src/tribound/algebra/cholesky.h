#pragma once

/// @file cholesky.h
/// Sparse factors of a symmetric matrix, to solve with and to tell whether it is positive definite.

#include <memory>
#include <span>

#include "tribound/algebra/petsc.h"

namespace tribound::algebra
{

/// How many sparse matrices this process has factored so far.
[[nodiscard]] int n_factorisations();

/// L D L^T = A without pivoting. Keeps its own copy of what it needs of A.
class SparseCholesky
{
 public:
  /// `a` is symmetric; `dim` is that of the mesh behind it and selects the ordering. Throws SolveError when
  /// the memory does not suffice.
  SparseCholesky(const SparseMatrix& a, int dim);

  /// Whether all of D is positive: then A is positive definite, up to the rounding of the factorisation.
  [[nodiscard]] bool positive_definite() const { return positive_definite_; }
  /// x = A^{-1} b, where A is positive definite.
  void solve(std::span<const double> b, std::span<double> x) const;

 private:
  MatHandle factors_;
  bool positive_definite_ = false;
};

}  // namespace tribound::algebra
