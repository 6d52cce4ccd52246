#include "tribound/certify/equilibrate/weak_symmetry.h"

#include <cmath>

#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

constexpr std::array<int, 2> diagonal_entries = {0, 3};

}  // namespace

WeakSymmetry::WeakSymmetry(const MeridianReference& reference, const MeridianCell& cell,
                           const MatrixXd& products, const MatrixXd& times_r, const StressMetric& metric)
    : reference_(reference),
      cell_(cell),
      products_(products),
      times_r_(times_r),
      metric_(metric),
      kappa_(metric.trace / (metric.scale + 3 * metric.trace)),
      n_(products.rows()),
      leading_(in_basis(MatrixXd::Identity(reference.n_divergence, reference.n_stress)))
{
  for (int k = 0; k < 2; ++k)
    derivative_[k] = in_basis(cell.sorted.inverse(0, k) * reference.derivative[0] +
                              cell.sorted.inverse(1, k) * reference.derivative[1]);
  divergence_ = MatrixXd::Zero(reference.n_divergence, 4 * n_);
  for (int k = 0; k < 2; ++k) divergence_.middleCols(k * n_, n_) = derivative_[k];
}

MatrixXd WeakSymmetry::in_basis(const MatrixXd& matrix) const
{
  if (cell_.has_edge_on_axis) return matrix * cell_.basis;
  return matrix;
}

MatrixXd WeakSymmetry::gram() const
{
  const MatrixXd radius = times_r_.topRows(reference_.n_divergence);
  MatrixXd result = (1 - kappa_) * (divergence_.transpose() * radius * divergence_);
  for (int entry = 0; entry < 4; ++entry) result.block(entry * n_, entry * n_, n_, n_) += products_;
  const MatrixXd mixed = leading_.transpose() * divergence_;  // (tr d, div d_r)
  for (const int i : diagonal_entries)
  {
    for (const int j : diagonal_entries) result.block(i * n_, j * n_, n_, n_) -= kappa_ * products_;
    result.middleRows(i * n_, n_) -= kappa_ * mixed;
    result.middleCols(i * n_, n_) -= kappa_ * mixed.transpose();
  }
  return result / metric_.scale;
}

MatrixXd WeakSymmetry::conditions() const
{
  const int m = reference_.n_divergence;
  const int p = reference_.n_facet - 2;
  const int n_skew = cell_.has_edge_on_axis ? fem::polynomial_dimension(2, p - 1) : m;
  MatrixXd result = MatrixXd::Zero(4 * n_, m + n_skew);
  for (int k = 0; k < 2; ++k) result.block((2 + k) * n_, 0, n_, m) = derivative_[k].transpose();
  result.block(n_, m, n_, n_skew) = leading_.topRows(n_skew).transpose();
  result.block(2 * n_, m, n_, n_skew) = -leading_.topRows(n_skew).transpose();
  return result;
}

MatrixXd WeakSymmetry::trace(int row, int facet) const
{
  const SortedCell<2>& sorted = cell_.sorted;
  const MatrixXd values = in_basis(reference_.trace[facet]);
  MatrixXd result = MatrixXd::Zero(4 * n_, reference_.n_facet);
  for (int k = 0; k < 2; ++k)
    result.middleRows((2 * row + k) * n_, n_) =
        -sorted.grad[facet][k] / std::sqrt(sorted.grad_norm[facet]) * values.transpose();
  return result;
}

VectorXd WeakSymmetry::load(const VectorXd& hat, const VectorXd& load) const
{
  const VectorXd hoop = hat.head(reference_.n_divergence) + times_r_.transpose() * load;  // r rho in P^p
  VectorXd result = (1 - kappa_) * (divergence_.transpose() * hoop);
  const VectorXd mean =
      cell_.has_edge_on_axis ? hoop : VectorXd(products_ * hat + load);  // rho and the basis
  for (const int i : diagonal_entries) result.segment(i * n_, n_) -= kappa_ * mean;
  return result / metric_.scale;
}

}  // namespace tribound::certify
