#include "tribound/base/dense_factors.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace tribound
{

CholeskyFactors::CholeskyFactors(const Eigen::MatrixXd& a)
{
  const Eigen::LLT<Eigen::MatrixXd> factors(a);
  lower_ = factors.matrixL();
  is_definite_ = factors.info() == Eigen::Success;
}

Eigen::MatrixXd CholeskyFactors::solve(const Eigen::MatrixXd& b) const
{
  return solve_lower_transposed(lower_, solve_lower(lower_, b));
}

Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& b)
{
  return lower.triangularView<Eigen::Lower>().solve(b);
}

Eigen::MatrixXd solve_lower_transposed(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& b)
{
  return lower.transpose().triangularView<Eigen::Upper>().solve(b);
}

Eigen::MatrixXd solve_regular(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  return a.partialPivLu().solve(b);
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a)
{
  return a.partialPivLu().inverse();
}

Eigen::MatrixXd least_norm_solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double threshold)
{
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  if (threshold > 0) factors.setThreshold(threshold);
  factors.compute(a);
  return factors.solve(b);
}

struct PivotedQr::Factors
{
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
};

PivotedQr::PivotedQr(const Eigen::MatrixXd& a)
    : factors_(new Factors{Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a)})
{
}

PivotedQr::~PivotedQr() = default;

Eigen::MatrixXd PivotedQr::upper() const
{
  return factors_->qr.matrixR().triangularView<Eigen::Upper>();
}

Eigen::MatrixXd PivotedQr::permuted(const Eigen::MatrixXd& x) const
{
  return factors_->qr.colsPermutation().transpose() * x;
}

Eigen::MatrixXd PivotedQr::times_q(Eigen::MatrixXd x) const
{
  const auto& qr = factors_->qr;
  Eigen::VectorXd workspace(x.cols());
  for (Eigen::Index k = qr.hCoeffs().size() - 1; k >= 0; --k)
  {
    const Eigen::Index below = x.rows() - k - 1;
    x.bottomRows(below + 1).applyHouseholderOnTheLeft(qr.matrixQR().col(k).tail(below), qr.hCoeffs()[k],
                                                      workspace.data());
  }
  return x;
}

Eigen::VectorXd PivotedQr::solve(const Eigen::VectorXd& b) const
{
  return factors_->qr.solve(b);
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigen tridiagonal_eigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& off_diagonal)
{
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd tridiagonal_eigenvalues(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& off_diagonal)
{
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

RightSingular right_singular(const Eigen::MatrixXd& a)
{
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace tribound
