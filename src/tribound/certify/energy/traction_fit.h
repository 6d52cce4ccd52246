#pragma once

/// @file traction_fit.h
/// On a facet of Gamma_C, the polynomial nearest to a given traction among those whose coefficients obey the
/// law, and its derivative by that traction. Only for the implementation of tractions.

#include <memory>
#include <span>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/base/types.h"
#include "tribound/certify/energy/contact_frames.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/lagrange.h"

namespace tribound::certify
{

/// The admissible values of a traction coefficient: |t^t| <= limit - coefficient t^n, t^n <= 0; if
/// coefficient > 0, limit = 0. Of sliders all with t^t = 0, between tied bodies all values.
template <int dim>
struct TractionCone
{
  Point<dim> normal;
  double limit;
  double coefficient;
  bool is_tied = false;
  bool is_bilateral = false;

  [[nodiscard]] bool contains(const Point<dim>& t, double tolerance) const;
  /// The nearest point.
  [[nodiscard]] Point<dim> nearest(const Point<dim>& t) const;
  /// Its derivative by t, symmetric with eigenvalues in [0, 1]; if there are several, one of them.
  [[nodiscard]] Tensor<dim> derivative(const Point<dim>& t) const;
};

/// Bernstein's basis of the degree at points of the reference facet, [point, coefficient].
template <int dim>
[[nodiscard]] Eigen::MatrixXd bernstein_at(int degree, std::span<const Point<dim - 1>> points);
/// Coefficients in the basis from values at its nodes, [coefficient, node].
template <int k>
[[nodiscard]] Eigen::MatrixXd bernstein_from_nodes(const fem::LagrangeBasis<k>& basis);
/// Coefficients of the higher degree from those of the lower one, [coefficient, coefficient]; means of these.
template <int dim>
[[nodiscard]] Eigen::MatrixXd bernstein_raised(int lower, int higher);

/// Whether t_h on the segment is made a polynomial of degree p though N varies: on a cell that touches the
/// axis of a body of revolution, where the loss of another one has no bound. y_h then has the degree p - 2.
template <int dim>
[[nodiscard]] bool is_low(const contact::NitscheForm<dim>& form, const ContactFrames<dim>& frames,
                          std::size_t k);

/// Fits coefficients to tractions at the contact points of a facet. The products of the basis differ between
/// facets only by the factor det of the segment; products here are without it. Keeps a reference to the form.
template <int dim>
class TractionFit
{
 public:
  /// Vectors at the points of a facet, or coefficients.
  using Columns = Eigen::Matrix<double, dim, Eigen::Dynamic>;

  explicit TractionFit(const contact::NitscheForm<dim>& form) : TractionFit(form, form.space().degree()) {}

  /// The basis at the points, [point, coefficient].
  [[nodiscard]] const Eigen::MatrixXd& at_points() const { return at_points_; }
  [[nodiscard]] const ContactFrames<dim>& frames() const { return frames_; }
  /// M^T t, t at the points of facet k.
  [[nodiscard]] Columns turned(std::size_t k, Columns t) const;
  /// The same for a field at the contact points.
  [[nodiscard]] Columns columns(std::size_t k, std::span<const Point<dim>> t) const;
  /// The cones of the coefficients on facet k. Limits are thresholds in Bernstein's basis, from their values
  /// at the nodes; none is negative.
  [[nodiscard]] std::vector<TractionCone<dim>> cones(std::size_t k) const;

  /// Coefficients of the t_h on facet k that is nearest to t, given at the points; of the degree p - 2 if
  /// is_low(), raised to p: in the cones all the same, since the narrowest counts.
  [[nodiscard]] Columns nearest(std::size_t k, const Columns& t) const;
  /// The matrix (Dt_h(t)[z_i], z_j) for these.
  [[nodiscard]] Eigen::MatrixXd rates(std::size_t k, const Columns& t, std::span<const Columns> z) const;
  /// Coefficients in the cones of the t_h nearest to t, given at the points. If the projection of t on
  /// polynomials is in the cones, it is taken; otherwise the coefficients are optimised one after another.
  [[nodiscard]] Columns operator()(const Columns& t, std::span<const TractionCone<dim>> cones) const;
  /// The matrix (Dt_h(t)[z_i], z_j) for polynomials z_i given at the points.
  [[nodiscard]] Eigen::MatrixXd tangent(const Columns& t, std::span<const TractionCone<dim>> cones,
                                        std::span<const Columns> z) const;
  /// The matrix (z_i, z_j).
  [[nodiscard]] Eigen::MatrixXd gram(std::span<const Columns> z) const;

 private:
  TractionFit(const contact::NitscheForm<dim>& form, int degree);

  /// As many of the narrowest of the cones on facet k as a polynomial of lower degree has coefficients.
  [[nodiscard]] std::vector<TractionCone<dim>> narrowest(std::size_t k, std::size_t n) const;

  const contact::NitscheForm<dim>& form_;
  ContactFrames<dim> frames_;
  fem::LagrangeBasis<dim - 1> basis_;
  Eigen::MatrixXd from_values_;
  Eigen::MatrixXd at_points_;
  Eigen::MatrixXd weighted_;  ///< maps values at the points to moments
  Eigen::MatrixXd gram_;
  CholeskyFactors factors_;
  std::unique_ptr<const TractionFit> low_;  ///< of degree p - 2; null where none is needed, or has none
};

}  // namespace tribound::certify
