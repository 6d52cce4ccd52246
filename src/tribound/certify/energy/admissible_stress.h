#pragma once

/// @file admissible_stress.h
/// The statically admissible symmetric stress of a cell that is nearest to a given discrete stress.

#include <array>
#include <span>

#include "tribound/certify/energy/alfeld.h"
#include "tribound/problem/material.h"

namespace tribound::certify
{

/// tau: symmetric, of degree q on the pieces of the cell, tau n continuous between them, div tau = div
/// sigma_h and tau n = (sigma_h - w_0) n on the facets, with w_0 the mean of the skew part of sigma_h. Of all
/// these stresses it is nearest to sigma(v) in the norm of C^{-1}. The traction and the divergence of a
/// symmetric stress do no work in rotations of the cell, which requires w_0 = 0.
template <int dim, int q>
struct AdmissibleStress
{
  PiecewiseStress<dim, q> difference;  ///< tau - sigma(v)
  double square = 0;                   ///< (C^{-1} (tau - sigma(v)), tau - sigma(v))_T
  double unbalanced = 0;               ///< ||w_0||_T, to be compared with ||sigma_h||_T
};

/// Let rho = tau - sym sigma_h. Its traction and divergence are those of the skew part w - w_0, of mean 0;
/// the free part of rho has none. Both parts are known on the reference cell
/// (certify/energy/alfeld_reference.h):
///
///     rho^ = sum_j w^_j L_j + sum_k alpha_k K_k,      (C^{-1} J K_k J^T, sym sigma_h + rho - sigma(v))_T =
///     0,
///
/// alpha follows by Cholesky factorisation from the products of the K_k in the metric of the cell. tau is
/// admissible for any alpha. If rounding keeps the matrix from being positive definite, alpha is 0 and tau
/// not the nearest (cells a million times as long as high were not enough). One object per thread: it keeps
/// the factors for the next stress on a cell with the same metric up to rounding, of which the square feels
/// the square. Compiled for each dimension and degree by certify/energy/kernel.cpp.in.
template <int dim, int q>
class AdmissibleStressSolver
{
 public:
  using S = AlfeldSizes<dim, q>;

  /// sigma_h of degree q as Stress stores it on the cell, both parts added; sigma(v) symmetric, of degree q
  /// or less, stored likewise, as by discrete_stress().
  [[nodiscard]] AdmissibleStress<dim, q> solve(const SortedCell<dim>& cell, const problem::Material& material,
                                               std::span<const double> sigma_h,
                                               std::span<const double> sigma_v);

 private:
  using Metric = Eigen::Matrix<double, S::components, S::components>;

  /// Makes the difference as small as possible; `map` maps the components of tau^ to those of J tau^ J^T.
  void minimise(const Metric& map, const Metric& compliance, PiecewiseStress<dim, q>& difference);
  /// Factors the products of the functions of the kernel in a metric of tau^; false if rounding prevents it.
  [[nodiscard]] bool factor(const Metric& metric);

  static constexpr double same = 1e-12;  ///< metrics that differ by less, relative to the diagonal

  Metric metric_ = Metric::Zero();  ///< that of the factors
  bool is_definite_ = false;
  Dense<S::kernel, S::kernel> gram_;
  std::array<double, S::kernel> reciprocal_{};
};

}  // namespace tribound::certify
