#pragma once

/// @file radial_projection.h
/// Data as the stress of an axisymmetric problem has them, for check_identities(): r times the projection
/// with the weight r onto polynomials of one degree less.

#include <Eigen/Core>
#include <span>

#include "tribound/base/dense_factors.h"
#include "tribound/base/types.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

/// On a cell (k = 2) or facet (k = 1) with an orthonormal basis of P^degree.
template <int k>
class RadialProjection
{
 public:
  explicit RadialProjection(int degree)
      : products_(Eigen::MatrixXd::Zero(fem::polynomial_dimension(k, degree),
                                        fem::polynomial_dimension(k, degree - 1)))
  {
  }

  /// A point of a rule: the values of the basis, and the weight times r.
  void add(std::span<const double> basis, double weight)
  {
    const Eigen::Map<const Eigen::VectorXd> theta(basis.data(), products_.rows());
    products_ += weight * theta * theta.head(products_.cols()).transpose();
  }
  /// From the moments of r f to those of r Pi f.
  void apply(std::span<Point<2>> moments) const
  {
    const Eigen::Index n = products_.cols();
    Eigen::Map<Eigen::Matrix<double, 2, Eigen::Dynamic>> all(moments.data()->data(), 2, products_.rows());
    const Eigen::MatrixXd projection = solve_regular(products_.topRows(n), all.leftCols(n).transpose());
    all = (products_ * projection).transpose();
  }

 private:
  Eigen::MatrixXd products_;  ///< (r theta_j, theta_i), theta_j of lower degree
};

}  // namespace tribound::certify
