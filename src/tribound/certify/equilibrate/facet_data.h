#pragma once

/// @file facet_data.h
/// What the boundary prescribes for the patch stresses: moments of psi_a times the traction, method
/// section 4.

#include <array>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/reference.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/springs.h"

namespace tribound::certify
{

/// Conditions and tractions on the boundary facets. Moments (psi_a t, theta_i)_F are taken with the reference
/// quadrature rule, on contact facets segment by segment, and in the orthonormal basis theta of the facet
/// with its vertices in ascending order.
template <int dim, int p>
class FacetData
{
 public:
  using S = Sizes<dim, p>;
  using FacetVector = DenseVector<S::block>;
  /// Moments for each vertex of the facet; entry c * S::facet + i belongs to component c.
  using Moments = std::array<FacetVector, dim>;

  /// `tractions`: what the parts of the stress carry on Gamma_C, at the contact points of the form.
  FacetData(const contact::NitscheForm<dim>& form, std::span<const double> u,
            typename Stress<dim>::Tractions tractions);

  [[nodiscard]] bool is_boundary(Index facet) const { return number_[facet] >= 0; }
  /// Whether Gamma_D fixes the component on the facet.
  [[nodiscard]] bool fixes(Index facet, int component) const
  {
    return conditions_[number_[facet]].fixed[component];
  }
  [[nodiscard]] bool fixes_any(Index facet) const;
  /// Parts of the stress: dis, lin and reg as far as they have tractions.
  [[nodiscard]] int n_parts() const { return n_parts_; }
  /// psi_a g_N or psi_a T(u), -psi_a T(u) on a master; null where the facet carries no load.
  [[nodiscard]] const Moments* discretisation(Index facet) const
  {
    const int index = conditions_[number_[facet]].moments;
    return index < 0 ? nullptr : &discretisation_[index];
  }
  /// psi_a (t^k - T_delta(u)); null off Gamma_C.
  [[nodiscard]] const Moments* linearisation(Index facet) const
  {
    const int index = conditions_[number_[facet]].contact;
    return index < 0 ? nullptr : &linearisation_[index];
  }
  /// psi_a (T_delta(u) - T(u)); null off Gamma_C. There is none for delta = 0.
  [[nodiscard]] const Moments* regularisation(Index facet) const
  {
    const int index = conditions_[number_[facet]].contact;
    return index < 0 ? nullptr : &regularisation_[index];
  }
  [[nodiscard]] const typename Stress<dim>::Tractions& tractions() const { return tractions_; }
  /// Whether the vertex lies on Gamma_C.
  [[nodiscard]] bool on_contact(Index vertex) const { return on_contact_[vertex]; }

 private:
  struct Condition
  {
    std::array<bool, dim> fixed{};
    int moments = -1;  ///< index in discretisation_
    int contact = -1;  ///< index in linearisation_ and regularisation_
  };
  [[nodiscard]] Moments& discretisation_of(Condition& condition);
  /// g_N on a boundary facet, and the springs there.
  void add_load(const contact::NitscheForm<dim>& form, std::size_t number,
                std::span<const Point<dim>> springs);
  /// What segment k exerts on the facet of one of its sides.
  void add_contact(const contact::NitscheForm<dim>& form, std::size_t k,
                   const contact::SegmentSide<dim>& side);

  std::vector<int> number_;            ///< per facet: number in Mesh::boundary(), or -1 inside Omega
  std::vector<Condition> conditions_;  ///< of the boundary facets
  std::vector<Moments> discretisation_;
  std::vector<Moments> linearisation_;
  std::vector<Moments> regularisation_;
  typename Stress<dim>::Tractions tractions_;
  std::vector<char> on_contact_;
  int n_parts_;
};

}  // namespace tribound::certify
