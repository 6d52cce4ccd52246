#pragma once

/// @file weak_symmetry.h
/// The weakly symmetric stresses on a cell of an axisymmetric problem: docs/revolution-energy.md, "Patches".
///
/// A field d is a difference of tensors tau = r sigma; coefficients of the entry (r, c) in the basis of the
/// cell begin at (2 r + c) n. With s = r div d_r + r rho the compliance makes of it, kappa = lambda / (2 mu +
/// 3 lambda),
///     1/2 int 1/r (|d|^2 + s^2 - kappa (tr d + s)^2) / (2 mu),
/// where s is r times the difference of hoop stresses.

#include <Eigen/Core>
#include <array>

#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/meridian_cell.h"

namespace tribound::certify
{

/// Matrices of the fields of a cell, which has its basis. All arguments must outlive the object.
class WeakSymmetry
{
 public:
  /// `products`: (., . / r) of one entry. `metric`: 2 mu and lambda.
  WeakSymmetry(const MeridianReference& reference, const MeridianCell& cell, const Eigen::MatrixXd& products,
               const Eigen::MatrixXd& times_r, const StressMetric& metric);

  /// Their products, rho = 0.
  [[nodiscard]] Eigen::MatrixXd gram() const;
  /// By columns: the divergence of the axial row in P^p, then twice the skew part in Lambda: P^p, on cells
  /// with an edge on the axis P^{p-1}.
  [[nodiscard]] Eigen::MatrixXd conditions() const;
  /// By columns: the normal trace of a row on a facet.
  [[nodiscard]] Eigen::MatrixXd trace(int row, int facet) const;
  /// The products with (0, r rho), from rho = hat / r + load for two polynomials of P^q.
  [[nodiscard]] Eigen::VectorXd load(const Eigen::VectorXd& hat, const Eigen::VectorXd& load) const;

 private:
  /// The components of a form by functions of P^q: of those of the basis.
  [[nodiscard]] Eigen::MatrixXd in_basis(const Eigen::MatrixXd& matrix) const;

  const MeridianReference& reference_;
  const MeridianCell& cell_;
  const Eigen::MatrixXd& products_;
  const Eigen::MatrixXd& times_r_;
  const StressMetric metric_;
  const double kappa_;
  Eigen::Index n_;                             ///< functions of the basis
  std::array<Eigen::MatrixXd, 2> derivative_;  ///< along r and z, in P^p
  Eigen::MatrixXd leading_;                    ///< the part in P^p
  Eigen::MatrixXd divergence_;                 ///< of the radial row, of all fields
};

}  // namespace tribound::certify
