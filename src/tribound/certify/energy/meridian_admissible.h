#pragma once

/// @file meridian_admissible.h
/// Stresses (sigma, vartheta) of bodies of revolution on the barycentric split of the cells of the meridian,
/// their products in the norm of C^{-1}, and the statically admissible one nearest to that of a displacement;
/// docs/revolution-energy.md. q = p + 1 is the degree of tau = r sigma.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/fem/meridian_rules.h"
#include "tribound/problem/material.h"

namespace tribound::certify
{

/// Columns: r sigma_rr, r sigma_zz, root 2 r sigma_rz, r vartheta. Rows are coefficients: on a cell those of
/// phi_j / sqrt(det J), as in Stress; on the pieces, row i * n + j, n = dim P^q, those of function j of piece
/// i as in PiecewiseStress.
using MeridianStress = Eigen::Matrix<double, Eigen::Dynamic, 4>;

/// The products (C^{-1} a, b) = int (C^{-1} (r a)) : (r b) / r of stresses on the pieces of a cell.
struct MeridianMetric
{
  problem::Material material;
  std::array<Eigen::MatrixXd, 3> lower;  ///< L L^T: the products (phi_j, phi_k / r) on each piece
  double error;                          ///< of the rule of 1 / r, relative

  /// At most error ||a|| ||b|| away from the exact product, both norms by this rule.
  [[nodiscard]] double product(const MeridianStress& a, const MeridianStress& b) const;
  /// ||a||^2 or more.
  [[nodiscard]] double square(const MeridianStress& a) const { return (1 + error) * product(a, a); }
  /// How far product(a, b) may be away.
  [[nodiscard]] double doubt(const MeridianStress& a, const MeridianStress& b) const;
  /// Coefficients in bases that are orthonormal with the weight 1 / r.
  [[nodiscard]] Eigen::MatrixXd in_orthonormal_basis(const Eigen::MatrixXd& on_pieces) const;
};

/// tau: symmetric, of degree q on the pieces, tau n continuous between them, div tau = div tau_h, tau n =
/// tau_h n on the facets, and 0 on an edge on the axis. Of these stresses with vartheta_h it is nearest to
/// the target in the norm of C^{-1}. (tau_h, W)_T = 0 is required for constant skew W.
struct AdmissibleMeridianStress
{
  MeridianStress difference;  ///< from the target, on the pieces
  double unbalanced = 0;      ///< L2 norm of the mean skew part of tau_h
};

/// Works on any cell; any number of threads may call it.
class MeridianStressSolver
{
 public:
  /// The radii of the vertices of the cells, which are in ascending order.
  MeridianStressSolver(std::vector<std::array<double, 3>> radii, int q);

  [[nodiscard]] MeridianMetric metric(Index cell, const problem::Material& material) const;
  /// Of degree q or less on a cell.
  [[nodiscard]] MeridianStress on_pieces(const MeridianStress& on_cell) const;
  /// tau_h as Stress stores it; r vartheta_h and the target are polynomials of degree q or less on the cell.
  /// If rounding keeps the products of the free part from being positive definite, the stress is admissible
  /// but not the nearest.
  [[nodiscard]] AdmissibleMeridianStress solve(Index cell, const SortedCell<2>& sorted,
                                               const MeridianMetric& metric, std::span<const double> tau_h,
                                               const Eigen::VectorXd& r_vartheta_h,
                                               const MeridianStress& target) const;

 private:
  /// From alfeld_factors(): three columns for each function.
  struct Reference
  {
    Eigen::MatrixXd kernel;
    Eigen::MatrixXd lifting;
  };

  [[nodiscard]] const Reference& reference(Index cell) const;
  void minimise(const Reference& reference, const MeridianMetric& metric, const Tensor<2>& jacobian,
                MeridianStress& difference) const;

  int q_;
  int n_;  ///< dim P^q
  std::vector<std::array<double, 3>> radii_;
  fem::MeridianRules rules_;             ///< of piece i of cell c: number 3 c + i
  std::vector<Eigen::MatrixXd> phi_;     ///< at the points of each rule, row by row
  Eigen::MatrixXd restriction_;          ///< of functions on the cell to the pieces, column by column
  std::array<Reference, 4> references_;  ///< facet 0, 1, 2 on the axis, no facet there
};

}  // namespace tribound::certify
