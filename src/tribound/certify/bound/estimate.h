#pragma once

/// @file estimate.h
/// The bound of an iterate with its components, method section 5.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tribound/certify/bound/algebraic.h"
#include "tribound/certify/bound/components.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/data_terms.h"
#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/bound/meridian_terms.h"
#include "tribound/certify/bound/transfer_terms.h"
#include "tribound/certify/equilibrate/stress_tabulation.h"

namespace tribound::certify
{

/// The sums over the cells.
struct Bound
{
  BoundComponents global;  ///< (sum of squares over the cells)^{1/2}, component by component
  double total = 0;        ///< (sum_T total_T^2)^{1/2} + quad + alg, as in the paper
  double total_sharp = 0;  ///< the bound with total_sharp_T: ||R(u^k)||_* <= total_sharp
};

struct Estimate : Bound
{
  std::vector<BoundComponents> cells;  ///< the cells that the rank owns

  /// Without the cells.
  [[nodiscard]] const Bound& bound() const { return *this; }
};

/// Evaluates every component on every cell, for the iterates on one mesh. All ranks construct and call it
/// together.
template <int dim>
class Estimator
{
 public:
  /// Evaluates what depends on the data alone. C_F may be `known` from a mesh that the form's mesh refines;
  /// otherwise it is computed.
  explicit Estimator(const contact::NitscheForm<dim>& form, ContactRule rule = ContactRule::resolved,
                     const std::optional<FriedrichsConstant>& known = {});

  /// If it is infinite, the bound has no alg; then the stress must satisfy div sigma_h + Pi^{p-1} f = 0.
  [[nodiscard]] const FriedrichsConstant& friedrichs() const { return friedrichs_; }

  /// rho of the iterate u with its equilibrated stress; empty where C_F is infinite.
  [[nodiscard]] AffineFields<dim> algebraic_remainder(std::span<const double> u,
                                                      const Stress<dim>& stress) const;
  /// C_F ||rho|| with rho from <R_lin, phi_i>: not less than alg in the bound.
  [[nodiscard]] double algebraic_bound(std::span<const double> residual, PatchStress patches) const
  {
    return friedrichs_.value *
           field_norm<dim>(form_.problem(), form_.space().mesh(), algebraic_.body_force(residual, patches));
  }

  /// The components of the iterate u with its equilibrated stress and rho. Cells are distributed over
  /// `n_threads` threads (0: as many as OpenMP offers).
  [[nodiscard]] Estimate operator()(std::span<const double> u, const Stress<dim>& stress,
                                    const AffineFields<dim>& rho, int n_threads = 0) const;
  /// The same with rho computed anew.
  [[nodiscard]] Estimate operator()(std::span<const double> u, const Stress<dim>& stress,
                                    int n_threads = 0) const
  {
    return (*this)(u, stress, algebraic_remainder(u, stress), n_threads);
  }

  /// The global lin1, lin2n and lin2t of an iterate, from its sigma_lin alone; the others are 0.
  [[nodiscard]] BoundComponents linearisation(const Stress<dim>& stress) const;

 private:
  /// Working space for one cell.
  struct CellFields
  {
    std::vector<double> dis;              ///< sigma_dis, [(a dim + k) n_points + q]
    std::vector<double> derivative;       ///< d_k u_a in reference coordinates, same layout
    std::vector<Tensor<dim>> difference;  ///< sigma_dis - sigma(u) at the points, with Pi^p sigma_0
  };

  void evaluate(std::span<const double> u, const Stress<dim>& stress, Index cell, CellFields& fields) const;
  [[nodiscard]] double norm_of_difference(Index cell, const CellFields& fields) const;
  void stress_terms(std::span<const double> u, const Stress<dim>& stress, int n_threads,
                    Estimate& result) const;
  void meridian_terms(std::span<const double> u, const Stress<dim>& stress, const AffineFields<dim>& rho,
                      Estimate& result) const;
  [[nodiscard]] double square_of_lin(const Stress<dim>& stress) const;
  void transfer_terms(std::span<const double> u, const Stress<dim>& stress, Estimate& result) const;
  [[nodiscard]] std::function<Tensor<dim>(const Point<dim>&)> difference(std::span<const double> u,
                                                                         const Stress<dim>& stress,
                                                                         Index cell) const;
  void contact_terms(std::span<const double> u, const Stress<dim>& stress, Estimate& result) const;

  const contact::NitscheForm<dim>& form_;
  FriedrichsConstant friedrichs_;
  AlgebraicResidual<dim> algebraic_;
  ContactTerms<dim> contact_;
  std::optional<MeridianTerms> meridian_;  ///< of an axisymmetric problem
  fem::Quadrature<dim> rule_;              ///< exact to degree 2p
  StressTabulation<dim> stress_table_;     ///< basis of the stress at its points
  std::vector<double>
      gradient_;               ///< reference derivatives of the space's basis, [(k n_nodes + i) n_points + q]
  std::vector<double> theta_;  ///< orthonormal basis of P^p at the points, [q n + j]; empty without sigma_0
};

/// The components of one iterate.
template <int dim>
[[nodiscard]] Estimate estimate(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                const Stress<dim>& stress, ContactRule rule = ContactRule::resolved)
{
  return Estimator<dim>(form, rule)(u, stress);
}

}  // namespace tribound::certify
