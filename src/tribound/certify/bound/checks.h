#pragma once

/// @file checks.h
/// The identities on which the bound rests, method section 4, checked from the stress alone: nothing here is
/// shared with the code that builds it.

#include <span>

#include "tribound/certify/bound/algebraic.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Norms that should vanish, each relative to ||sigma_h||. Powers of h_T or h_F give them the unit of a
/// stress. Of axisymmetric problems sigma_h is tau = r sigma, which balances r f and r g: only the axial row
/// has a divergence prescribed, the projections are those of the patches (equilibrate/meridian_patch.h), and
/// tau on the axis, where it vanishes, counts as a jump.
struct IdentityDefects
{
  double divergence = 0;     ///< (sum h_T^2 ||div sigma_h + Pi^{p-1} f - rho||_T^2)^{1/2}
  double jump = 0;           ///< (sum h_F ||[sigma_h n]||_F^2)^{1/2} over facets inside Omega
  double neumann = 0;        ///< (sum h_F ||sigma_h n - Pi^p_F g_N||_F^2)^{1/2}, free components only
  double contact = 0;        ///< (sum h_F ||sigma_h n - Pi^p_F t^k||_F^2)^{1/2}
  double symmetry = 0;       ///< ||Pi^{p-1} skew sigma_h||; of cells with an edge on the axis Pi^{p-2}
  bool is_symmetric = true;  ///< whether symmetry is one of the identities: Stress::is_symmetric()

  /// The largest of the defects that apply; nan if one of them is.
  [[nodiscard]] double largest() const;
};

/// t: the running traction t^k at the contact points of the form. rho: what the linear solver has left, if it
/// is part of the bound; empty: 0. All ranks call it together, because facets between them count, too.
template <int dim>
[[nodiscard]] IdentityDefects check_identities(const contact::NitscheForm<dim>& form,
                                               std::span<const Point<dim>> t, const Stress<dim>& stress,
                                               const AffineFields<dim>& rho = {});

}  // namespace tribound::certify
