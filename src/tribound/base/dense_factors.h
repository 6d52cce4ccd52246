#pragma once

/// @file dense_factors.h
/// Factors, inverses and eigenvalues of small dense matrices, by Eigen. Eigen's decompositions are slow to
/// compile; behind this interface they are compiled once.

#include <Eigen/Core>
#include <memory>

namespace tribound
{

/// A = L L^T of a symmetric matrix, from its lower triangle.
class CholeskyFactors
{
 public:
  CholeskyFactors() = default;
  explicit CholeskyFactors(const Eigen::MatrixXd& a);

  /// Whether A was positive definite; the other members assume it.
  [[nodiscard]] bool is_definite() const { return is_definite_; }
  /// The lower triangular L.
  [[nodiscard]] const Eigen::MatrixXd& lower() const { return lower_; }
  /// A^{-1} b, column by column.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  Eigen::MatrixXd lower_;
  bool is_definite_ = false;
};

/// L^{-1} b and L^{-T} b for a lower triangular matrix.
[[nodiscard]] Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& b);
[[nodiscard]] Eigen::MatrixXd solve_lower_transposed(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& b);

/// A^{-1} b by LU factors with partial pivoting; A is nonsingular.
[[nodiscard]] Eigen::MatrixXd solve_regular(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// A^{-1} by LU factors with partial pivoting; A is nonsingular.
[[nodiscard]] Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a);

/// The least-squares solution with the least norm: the least |x| among those with the least |A x - b|.
/// Columns count as linearly dependent up to `threshold`, relative to the largest pivot; 0: up to rounding.
[[nodiscard]] Eigen::MatrixXd least_norm_solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                                  double threshold = 0);

/// A P = Q R by reflections with column pivoting: the longest remaining column first.
class PivotedQr
{
 public:
  explicit PivotedQr(const Eigen::MatrixXd& a);
  ~PivotedQr();
  PivotedQr(const PivotedQr&) = delete;
  PivotedQr& operator=(const PivotedQr&) = delete;

  /// The upper triangular R.
  [[nodiscard]] Eigen::MatrixXd upper() const;
  /// P^T x.
  [[nodiscard]] Eigen::MatrixXd permuted(const Eigen::MatrixXd& x) const;
  /// Q x, reflection by reflection.
  [[nodiscard]] Eigen::MatrixXd times_q(Eigen::MatrixXd x) const;
  /// A least-squares solution x, 0 in columns that depend on others.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Factors;
  std::unique_ptr<const Factors> factors_;
};

/// Eigenvalues in ascending order and orthonormal vectors, column by column.
struct SymmetricEigen
{
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);
/// The same for a tridiagonal matrix.
[[nodiscard]] SymmetricEigen tridiagonal_eigen(const Eigen::VectorXd& diagonal,
                                               const Eigen::VectorXd& off_diagonal);
/// Its eigenvalues alone.
[[nodiscard]] Eigen::VectorXd tridiagonal_eigenvalues(const Eigen::VectorXd& diagonal,
                                                      const Eigen::VectorXd& off_diagonal);

/// Singular values of A = U S V^T in descending order, and all of V.
struct RightSingular
{
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] RightSingular right_singular(const Eigen::MatrixXd& a);

}  // namespace tribound
