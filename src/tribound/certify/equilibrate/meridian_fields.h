#pragma once

/// @file meridian_fields.h
/// Polynomials on the cells of an axisymmetric problem, as the stresses tau = r sigma need them.
///
/// Coefficients belong to the basis of Stress, phi_j / sqrt(det J) with the vertices of a cell in ascending
/// order; the first of these functions span P^p.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>

#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

/// Integrals on the reference triangle and the reference facet for the degree p of a space, q = p + 1.
struct MeridianReference
{
  explicit MeridianReference(int p);

  int n_stress;                                 ///< dim P^q
  int n_divergence;                             ///< dim P^p
  int n_facet;                                  ///< dim P^q of a facet
  std::array<Eigen::MatrixXd, 2> derivative;    ///< d_k phi_j in P^p
  std::array<Eigen::MatrixXd, 3> trace;         ///< phi_j on facet f, in its orthonormal basis theta
  std::array<Eigen::MatrixXd, 3> hat;           ///< lambda_a phi_j in P^q for phi_j in P^p
  std::array<Eigen::MatrixXd, 2> hat_on_facet;  ///< lambda_v theta_j in P^q for theta_j in P^p
};

/// phi at the points of a rule, row by row, for each permutation_number() of a cell in whose own coordinates
/// the points are given.
using PermutedTables = std::array<Eigen::MatrixXd, 6>;
[[nodiscard]] PermutedTables tabulate_permuted(int degree, const fem::Quadrature<2>& rule);

/// The form must outlive the object. Any number of threads may call it.
class MeridianFields
{
 public:
  explicit MeridianFields(const contact::NitscheForm<2>& form);

  /// r times the stress of a displacement, in P^p.
  struct WeightedStress
  {
    std::array<std::array<Eigen::VectorXd, 2>, 2> plane;  ///< [row][column]; 0 is radial, 1 axial
    Eigen::VectorXd hoop;
  };
  [[nodiscard]] WeightedStress stress(Index c, const SortedCell<2>& cell, std::span<const double> u) const;

  /// rr, zz, rz and hoop: sigma_0 in P^{p+1}, as the form has its moments; not for cells without.
  [[nodiscard]] std::array<Eigen::VectorXd, 4> initial_stress(Index c, const SortedCell<2>& cell) const;
  [[nodiscard]] bool has_initial_stress(Index c) const { return form_.data().initial_stress().acts_on(c); }
  /// Adds r sigma_0 and r sigma_{0,tt} in P^p; on cells with an edge on the axis r times the projection of
  /// sigma_0 onto P^{p-1} with the weight r, of the entries in the meridian.
  void add_initial_stress(Index c, const SortedCell<2>& cell, WeightedStress& stress) const;

  /// The radial and the axial component of r f~ in P^p: the projection of r f; on cells with an edge on the
  /// axis r times the projection of f onto P^{p-1} with the weight r.
  [[nodiscard]] std::array<Eigen::VectorXd, 2> load(Index c, const SortedCell<2>& cell) const;

  /// On a cell with an edge on the axis, from moments of r f on P^p to those of r times the projection of f
  /// onto P^{p-1} with the weight r.
  void project_at_axis(const std::array<double, 3>& r, std::span<Eigen::VectorXd> moments) const;

  /// The products of r phi_j, phi_j in P^p, with P^q; r is given at the vertices.
  [[nodiscard]] Eigen::MatrixXd times_radius(const std::array<double, 3>& r) const;
  /// Of the vertices of a cell.
  [[nodiscard]] std::array<double, 3> radii(const SortedCell<2>& cell) const;
  [[nodiscard]] const MeridianReference& reference() const { return reference_; }

 private:
  const contact::NitscheForm<2>& form_;
  MeridianReference reference_;
  fem::Quadrature<2> stress_rule_;
  PermutedTables stress_phi_;             ///< P^p at its points
  fem::Tabulation<2> stress_tabulation_;  ///< the basis of the space there
  PermutedTables to_sorted_;              ///< from coefficients in a cell's own coordinates, in P^q
  PermutedTables body_phi_;               ///< P^p at the points of the rule of the loads
};

[[nodiscard]] inline bool has_edge_on_axis(const std::array<double, 3>& r)
{
  return std::ranges::count(r, 0.0) == 2;
}

}  // namespace tribound::certify
