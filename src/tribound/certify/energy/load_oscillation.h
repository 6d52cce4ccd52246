#pragma once

/// @file load_oscillation.h
/// What loads that are no polynomials, and contact tractions between meshes that do not match, add to the
/// energy bound, method sections 13.3 and 13.5.

#include <span>
#include <string>
#include <vector>

#include "tribound/certify/bound/contact_terms.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// |(f - Pi f, w) + (g - Pi g, w)_N - (sigma_0 - Pi^p sigma_0, eps(w))| <= sum_T O_T ||w||_en,T + missed
/// ||w||_en for all w that vanish where Gamma_D fixes them, g = g_N - K (u - u_0).
struct LoadOscillation
{
  std::vector<double> cells;  ///< O_T of the own cells
  double missed = 0;          ///< what quadrature may miss of the loads, of all ranks; infinite if K is
  std::string reason{};       ///< why it is not bounded, the same on all ranks; empty: it is
};

/// The largest s with s |eps|^2 <= C eps : eps, eps with the hoop strain on a meridian.
template <int dim>
[[nodiscard]] double least_stiffness(const contact::NitscheForm<dim>& form, Index cell);

/// `korn` is K of certify/bound/korn.h. On a meridian as meridian_oscillation.h has it. All ranks together.
template <int dim>
[[nodiscard]] LoadOscillation load_oscillation(const contact::NitscheForm<dim>& form,
                                               std::span<const double> u, double korn);

/// |(t, [w])_C - (Pi_F t, w)_S + (Pi_G t, w)_M| <= sum_T e_T ||w||_en,T: e_T of the own cells, for t at the
/// contact points, Pi_F and Pi_G the projections of the tractions on the facets of slave and master, method
/// section 11.4. 0 where meshes match.
template <int dim>
[[nodiscard]] std::vector<double> transfer_oscillation(const contact::NitscheForm<dim>& form,
                                                       const ContactTerms<dim>& terms,
                                                       std::span<const Point<dim>> t);

}  // namespace tribound::certify
