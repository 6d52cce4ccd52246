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

/// Brezzi-Douglas-Marini fields of degree p + 1 [BDM85]: on each triangle K polynomials, by their
/// coefficients in theta_i(s) / det_K^{1/2} e_c, s the reference coordinates of K, e_c the axes, theta_i
/// orthonormal of degree p + 1; number (2 K + c) n + i. This basis is orthonormal, so that the smallest field
/// under the conditions B x = b, which say what divergence and jumps are, is B^T (B B^T)^{-1} b.
class FacetFlux
{
 public:
  /// `vertices` places those of the cover in the plane, anticlockwise as they were.
  FacetFlux(const FacetCover& cover, std::span<const Point<2>> vertices, int degree);

  /// Of r, one column for each row of r, given by its moments (r, theta_j)_K / det_K^{1/2} of degree <= p,
  /// number K n + j: the smallest rho with div rho = r, normal component continuous and 0 on the rim.
  /// Nothing if rounding has made more than 1e-10 of r of it.
  [[nodiscard]] std::optional<Eigen::MatrixXd> with_divergence(const Eigen::MatrixXd& moments) const;

  /// The smallest field with the divergence and the normal jumps of another: what is left of that when the
  /// nearest field without either is taken off. Nothing if rounding has made more than 1e-10 times `size` of
  /// it.
  [[nodiscard]] std::optional<Eigen::MatrixXd> without_circulation(const Eigen::MatrixXd& field,
                                                                   double size) const;

 private:
  [[nodiscard]] std::optional<Eigen::MatrixXd> smallest(const Eigen::MatrixXd& conditions, double size) const;

  int n_moments_;  ///< of all triangles
  Eigen::SparseMatrix<double> conditions_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace tribound::certify
