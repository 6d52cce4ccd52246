#pragma once

/// @file facet_flux.h
/// Fields on a triangulated facet with given divergence and no flux through its rim.

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <optional>
#include <span>
#include <vector>

#include "tribound/certify/bound/facet_cover.h"

namespace tribound::certify
{

/// Brezzi-Douglas-Marini fields of degree p + 1 [BDM85]: polynomials on each triangle K, given by their
/// coefficients in theta_i(s) / det_K^{1/2} e_c, with s the reference coordinates of K, e_c the axes, theta_i
/// orthonormal of degree p + 1; number (2 K + c) n + i. This basis is orthonormal, so the smallest field
/// under the conditions B x = b on divergence and jumps is B^T (B B^T)^{-1} b.
class FacetFlux
{
 public:
  /// `vertices` places those of the cover in the plane and keeps them anticlockwise.
  FacetFlux(const FacetCover& cover, std::span<const Point<2>> vertices, int degree);

  /// The smallest rho with div rho = r, continuous normal component, 0 on the rim; one column for each row of
  /// r. r is given by its moments (r, theta_j)_K / det_K^{1/2} of degree <= p, number K n + j. Nothing if
  /// rounding exceeds 1e-10 of r.
  [[nodiscard]] std::optional<Eigen::MatrixXd> with_divergence(const Eigen::MatrixXd& moments) const;

  /// The smallest field with the divergence and the normal jumps of another, that is, the other less the
  /// nearest field without either. Nothing if rounding exceeds 1e-10 times `size`.
  [[nodiscard]] std::optional<Eigen::MatrixXd> without_circulation(const Eigen::MatrixXd& field,
                                                                   double size) const;

 private:
  [[nodiscard]] std::optional<Eigen::MatrixXd> smallest(const Eigen::MatrixXd& conditions, double size) const;

  int n_moments_;  ///< of all triangles
  Eigen::SparseMatrix<double> conditions_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace tribound::certify
