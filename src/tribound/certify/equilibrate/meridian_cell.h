#pragma once

/// @file meridian_cell.h
/// A cell of an axisymmetric problem with all that the patches around its vertices need of it.
///
/// The rows of tau = r sigma are of degree q = p + 1, multiples of r on cells with an edge on the axis.
/// Coefficients are those of certify/equilibrate/meridian_fields.h.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/equilibrate/cell_operator.h"
#include "tribound/certify/equilibrate/meridian_fields.h"
#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/meridian_rules.h"

namespace tribound::certify
{

/// Vertices ascend, as in SortedCell. `row` 0 is the radial one, 1 the axial one.
struct MeridianCell
{
  SortedCell<2> sorted;
  std::array<double, 3> r;  ///< of the vertices
  bool has_edge_on_axis;
  /// The coefficients of the basis in which a row is sought, component by component; empty: they are the
  /// unknowns.
  Eigen::MatrixXd basis;
  /// L L^T: the products of the fields of a problem, row by row (., . / r) of one component, weakly symmetric
  /// those of all four.
  CholeskyFactors mass;
  // Of the fields in that basis, all components, times L^{-T}:
  Eigen::MatrixXd conditions;  ///< row by row the divergence in P^p; else WeakSymmetry::conditions()
  /// [row of the problem][facet]: normal traces
  std::array<std::array<Eigen::MatrixXd, 3>, 2> trace;
  /// Weakly symmetric, [vertex]: WeakSymmetry::load() of psi_a.
  std::array<Eigen::VectorXd, 3> load;
  /// The inverse of (r ., .) on P^p.
  Eigen::MatrixXd compliance;
  double radius_integral;         ///< of r
  Eigen::VectorXd radius_moment;  ///< of r on P^p
  /// [row][component]: r sigma(u) in P^p. The initial stress, as all moments on P^p see r sigma_0; on cells
  /// with an edge on the axis r times its projection with the weight r onto P^{p-1}.
  std::array<std::array<Eigen::VectorXd, 2>, 2> sigma;
  /// r div (r sigma_r(u)) - r sigma_tt(u) and div (r sigma_z(u)) in P^p
  std::array<Eigen::VectorXd, 2> residual;
  /// [row][vertex]: moments on P^p of psi_a r^2 f_r and of psi_a r f_z. On cells with an edge on the axis the
  /// latter are those of r w, w the projection with the weight r of psi_a f_z onto P^{p-1}: div tau_z can
  /// then be divided by r. Less those of (K_{T,a} (x - x_T))_z.
  std::array<std::array<Eigen::VectorXd, 3>, 2> body;

  [[nodiscard]] bool is_on_axis(int facet) const
  {
    return r[(facet + 1) % 3] == 0 && r[(facet + 2) % 3] == 0;
  }
};

/// Prepares the cells of a form for the patches.
class MeridianCellSource
{
 public:
  /// The form must outlive the object. `metrics`: of the regions; empty: L2 everywhere, as it is row by row.
  explicit MeridianCellSource(const contact::NitscheForm<2>& form, bool by_rows = true,
                              std::vector<StressMetric> metrics = {});

  [[nodiscard]] const MeridianReference& reference() const { return fields_.reference(); }
  [[nodiscard]] bool is_by_rows() const { return by_rows_; }
  /// `turning`: K_{T,a} at the vertices, or empty. Throws SolveError for a cell without volume. Any number of
  /// threads may call it.
  [[nodiscard]] MeridianCell prepare(Index c, std::span<const double> u,
                                     std::span<const Tensor<2>> turning = {}) const;

 private:
  /// K_{T,a} (x - x_T) of the vertices in P^p, by component; 0 without.
  using Turning = std::array<std::array<Eigen::VectorXd, 2>, 3>;
  [[nodiscard]] Turning turning_in_cell(const SortedCell<2>& cell, std::span<const Tensor<2>> turning) const;
  /// (., . / r) of one component.
  [[nodiscard]] Eigen::MatrixXd products(const MeridianCell& cell, Index c, int permutation) const;
  void find_row_operators(MeridianCell& cell, const Eigen::MatrixXd& products) const;
  void find_symmetric_operators(MeridianCell& cell, Index c, const Eigen::MatrixXd& products,
                                const Turning& turning) const;
  void find_stress(MeridianCell& cell, Index c, std::span<const double> u) const;
  void find_body_moments(MeridianCell& cell, Index c, int permutation) const;

  const contact::NitscheForm<2>& form_;
  bool by_rows_;
  std::vector<StressMetric> metrics_;
  MeridianFields fields_;
  fem::MeridianRules rules_;
  std::vector<PermutedTables> phi_;  ///< P^q at the points of each of them
  PermutedTables body_phi_;          ///< P^p at the points of the rule of the loads
};

}  // namespace tribound::certify
