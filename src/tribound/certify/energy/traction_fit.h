#pragma once

/// @file traction_fit.h
/// The nearest polynomial on a facet of Gamma_C whose coefficients obey the law, and how it follows what it
/// is fitted to. For the implementation of tractions alone.

#include <span>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/lagrange.h"

namespace tribound::certify
{

/// Where a coefficient of a traction may be: |t^t| <= limit - coefficient t^n, t^n <= 0; with coefficient > 0
/// limit = 0. Between bodies that are tied anywhere.
template <int dim>
struct TractionCone
{
  Point<dim> normal;
  double limit;
  double coefficient;
  bool is_tied = false;

  [[nodiscard]] bool contains(const Point<dim>& t, double tolerance) const;
  /// The nearest point.
  [[nodiscard]] Point<dim> nearest(const Point<dim>& t) const;
  /// Its derivative by t, symmetric with eigenvalues in [0, 1]; where there are several, one of them.
  [[nodiscard]] Tensor<dim> derivative(const Point<dim>& t) const;
};

/// Bernstein's basis of the degree at points of the reference facet, [point, coefficient].
template <int dim>
[[nodiscard]] Eigen::MatrixXd bernstein_at(int degree, std::span<const Point<dim - 1>> points);
/// Its coefficients from values at the nodes of the basis, [coefficient, node].
template <int k>
[[nodiscard]] Eigen::MatrixXd bernstein_from_nodes(const fem::LagrangeBasis<k>& basis);

/// Fits coefficients to tractions at the contact points of a facet. On all facets the products of the basis
/// differ by a factor only, det of the segment: products here are without it. Keeps a reference to the form.
template <int dim>
class TractionFit
{
 public:
  /// Vectors at the points of a facet, or coefficients.
  using Columns = Eigen::Matrix<double, dim, Eigen::Dynamic>;

  explicit TractionFit(const contact::NitscheForm<dim>& form);

  /// The basis at the points, [point, coefficient].
  [[nodiscard]] const Eigen::MatrixXd& at_points() const { return at_points_; }
  /// Of a field by contact points what facet k has.
  [[nodiscard]] Columns columns(std::size_t k, std::span<const Point<dim>> t) const;
  /// Those of the coefficients on facet k. Limits are thresholds in Bernstein's basis, from their values at
  /// the nodes; none is negative.
  [[nodiscard]] std::vector<TractionCone<dim>> cones(std::size_t k) const;

  /// Coefficients in the cones of the nearest t_h to t, given at the points: where the projection of t on
  /// polynomials is there, that; else coefficient after coefficient is made the best.
  [[nodiscard]] Columns operator()(const Columns& t, std::span<const TractionCone<dim>> cones) const;
  /// The matrix (Dt_h(t)[z_i], z_j) for polynomials z_i given at the points.
  [[nodiscard]] Eigen::MatrixXd tangent(const Columns& t, std::span<const TractionCone<dim>> cones,
                                        std::span<const Columns> z) const;
  /// The matrix (z_i, z_j).
  [[nodiscard]] Eigen::MatrixXd gram(std::span<const Columns> z) const;

 private:
  const contact::NitscheForm<dim>& form_;
  fem::LagrangeBasis<dim - 1> basis_;
  Eigen::MatrixXd from_values_;
  Eigen::MatrixXd at_points_;
  Eigen::MatrixXd weighted_;  ///< moments from values at the points
  Eigen::MatrixXd gram_;
  CholeskyFactors factors_;
};

}  // namespace tribound::certify
