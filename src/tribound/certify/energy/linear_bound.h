#pragma once

/// @file linear_bound.h
/// Intervals of numbers that are linear in the solution, from the energy bound and dual pairs.

#include <span>
#include <vector>

#include "tribound/certify/energy/admissible_traction.h"
#include "tribound/certify/energy/dual_products.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/contact/nitsche/springs.h"

namespace tribound::certify
{

/// What an energy bound was computed from. Keeps references.
template <int dim>
struct BoundedState
{
  const contact::NitscheForm<dim>& form;
  const ObstacleFacets<dim>& facets;
  std::span<const double> v;
  std::span<const double> balanced;  ///< u~, to which the springs with the equilibrated stress belong
  const Stress<dim>& stress;         ///< equilibrated; tau is made from it
  const AdmissibleTraction<dim>& t_h;
  const EnergyBound& bound;
  std::vector<double> forces;   ///< L(phi_i) + (t_h, phi_i)_C, L without initial stress: tau is total
  std::vector<char> junctions;  ///< of the facets
  bool has_polynomial_loads;    ///< of degrees that rules integrate, with K u_0
  /// |L(z) - its value by quadrature| <= unresolved ||z||_en, with that of the initial stress.
  double unresolved;

  BoundedState(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets,
               std::span<const double> v, std::span<const double> balanced, const Stress<dim>& stress,
               const AdmissibleTraction<dim>& t_h, const EnergyBound& bound);

  /// L(z) + (t_h, z)_C - (tau, eps(z)): the effect of data that are not polynomials, and rounding.
  [[nodiscard]] double remainder(std::span<const double> z, double work) const
  {
    return form.space().dot(forces, z) - work;
  }
  /// Half the width of an interval, distributed over the cells in proportion to the energy.
  [[nodiscard]] std::vector<double> shares(double half_width) const;
};

/// dual_products() for the degree of the form, without the springs; and with them: pairs of a stress and a
/// force on S with products (., .)_{C^-1} + (K^-1 ., .)_S, (sigma(z), K z) for sigma(z).
template <int dim>
[[nodiscard]] DualProducts products_of_stresses(const BoundedState<dim>& state, const DualPair<dim>& pair);
template <int dim>
[[nodiscard]] DualProducts dual_products(const BoundedState<dim>& state, const DualPair<dim>& pair);

/// Sums of dual products over all ranks.
struct DualSums
{
  double centre = 0;
  double square = 0;
  double work = 0;
  double energy = 0;
  double absolute = 0;  ///< of the terms of centre and work: rounding is proportional to it
  double doubt = 0;

  DualSums(const DualProducts& products, const Ranks& ranks);
};

/// |number - centre| <= radius.
struct LinearBound
{
  double centre = 0;
  double radius = 0;
  double rounding = 0;
  std::vector<double> cells{};  ///< the shares of own cells in the radius
};

/// For l(u) + (sigma(u) n, phi)_C, with `base` = l(v) + (t_h, phi)_C. If y = z + phi and r = zeta n - l on
/// Gamma_C, and v and t_h satisfy there
///     |(sigma(u) n - t_h) . y - r . (u - v)| <= m (the four integrands on Gamma_C of method section 13.1),
/// the centre is base + 1/2 (zeta + sigma(z), tau - sigma(v)) + remainder(z), and the radius the largest eta
/// x + m (mid^2 - x^2) for 0 <= x <= mid, with eta = ||zeta - sigma(z)||, and ||O|| B_v for what zeta
/// lacks; m = 0 if y and r vanish.
template <int dim>
[[nodiscard]] LinearBound linear_bound(const BoundedState<dim>& state, double base, const DualPair<dim>& pair,
                                       const DualProducts& products, double m = 0);

}  // namespace tribound::certify
