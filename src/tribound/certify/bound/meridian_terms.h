#pragma once

/// @file meridian_terms.h
/// The components of the bound on the cells of axisymmetric problems, method section 19.2.

#include <span>
#include <vector>

#include "tribound/certify/bound/components.h"
#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/meridian_rules.h"

namespace tribound::certify
{

/// f_h of an axisymmetric problem at points of a cell, given in reference coordinates.
[[nodiscard]] std::vector<Point<2>> body_force_at(const contact::NitscheForm<2>& form, Index cell,
                                                  std::span<const Point<2>> points);

/// With the rows tau = r sigma_h of the stress, s_tt = div tau_r + r f_{h,r} of tau_dis, h = u_r / r,
///     osc = (h_T / pi) ||r^{-1/2} (r f_{h,z} + div tau_z - r rho_z)||, tau = tau_dis + tau_lin + tau_reg,
///     str^2 = ||r^{-1/2} (tau_dis - r sigma(u))||^2 + ||r^{1/2} (s_tt - sigma_tt(u))||^2, with what the
///             projection of the initial stress leaves out added to str,
///     lin1^2 = ||r^{-1/2} tau_lin||^2 + ||r^{1/2} div tau_{lin,r}||^2, reg1 likewise,
/// because with v_r / r among the strains
///     R(v) = (r f_z + div tau_z, v_z) + (tau - r sigma(u), grad v) + (s_tt - sigma_tt(u), v_r) + ...
class MeridianTerms
{
 public:
  /// The form must outlive the object.
  explicit MeridianTerms(const contact::NitscheForm<2>& form);

  /// Sets str, lin1 and reg1 of a cell, and adds the oscillation of f_h to osc.
  void add(Index cell, std::span<const double> u, const Stress<2>& stress, double rho_z,
           BoundComponents& eta) const;
  /// lin1^2 or reg1^2 of a cell from the coefficients of that part; empty: 0.
  [[nodiscard]] double square(Index cell, std::span<const double> block) const;

 private:
  /// Functions on reference cells at the points of a rule.
  struct Table
  {
    fem::Tabulation<2> displacement;
    /// The basis of the stress, by permutation_number() of the sorted cell.
    std::vector<fem::Tabulation<2>> stress;
  };
  /// tau and the divergence of its rows at a point.
  struct Rows
  {
    Tensor<2> tau = Tensor<2>::Zero();
    Point<2> divergence = Point<2>::Zero();
  };

  [[nodiscard]] Rows rows_at(const Table& table, const SortedCell<2>& cell, std::span<const double> block,
                             int q) const;
  struct InitialStress
  {
    Tensor<2> plane = Tensor<2>::Zero();
    double hoop = 0;
  };
  /// Its projection on P^{p+1} at a point of the rule of a cell.
  [[nodiscard]] InitialStress initial_at(const Table& table, Index cell, int q) const;

  const contact::NitscheForm<2>& form_;
  fem::MeridianRules rules_;
  std::vector<Table> tables_;  ///< of each rule
};

}  // namespace tribound::certify
