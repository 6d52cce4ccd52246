#pragma once

/// @file meridian_facets.h
/// What the boundary of an axisymmetric problem prescribes for the patch stresses.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/meridian_cell.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// The normal traces r Pi (psi_a t) on loaded and contact facets: Pi is the projection with the weight r onto
/// P^p of the facet, so that they can be divided by r on the axis.
class MeridianFacets
{
 public:
  /// `tractions`: what the parts of the stress carry on Gamma_C, at the contact points of the form; those of
  /// springs at u are added.
  MeridianFacets(const contact::NitscheForm<2>& form, const MeridianReference& reference,
                 std::span<const double> u, Stress<2>::Tractions tractions);

  [[nodiscard]] const Stress<2>::Tractions& tractions() const { return tractions_; }
  /// Parts of the stress: dis, lin and reg as far as they have tractions.
  [[nodiscard]] int n_parts() const { return n_parts_; }
  /// Whether the vertex lies on Gamma_C.
  [[nodiscard]] bool on_contact(Index vertex) const { return on_contact_[vertex] != 0; }
  /// Whether Gamma_D fixes the component on the facet.
  [[nodiscard]] bool fixes(Index facet, int component) const;
  /// Coefficients in P^q, column by component, of the trace with the hat function of the `end`-th of the
  /// ascending vertices of the facet; null where it is 0.
  [[nodiscard]] const Eigen::MatrixXd* trace(Index facet, int part, int end) const;

 private:
  using Ends = std::array<Eigen::MatrixXd, 2>;

  /// moments += weight psi_v theta_i t at the point s of a boundary facet, theta of degree p.
  void add(const mesh::BoundaryFacet& facet, const Point<1>& s, double weight, const Point<2>& t,
           Ends& moments) const;
  /// g_N - K (u - u_0).
  void add_load(std::size_t number, std::span<const double> u);
  void add_contact(std::size_t k, const contact::SegmentSide<2>& side);
  /// From the moments on P^p with the weight r to the coefficients of the projection times r.
  void project();
  [[nodiscard]] Ends& traces_of(std::size_t number, int part);

  const contact::NitscheForm<2>& form_;
  const MeridianReference& reference_;
  Stress<2>::Tractions tractions_;
  int n_parts_;
  std::vector<int> number_;                  ///< per facet: number in Mesh::boundary(), or -1 inside Omega
  std::vector<std::array<Ends, 3>> traces_;  ///< [number][part]; empty matrices: 0
  std::vector<char> on_contact_;
};

}  // namespace tribound::certify
