#pragma once

/// @file admissible_displacement.h
/// Kinematically admissible displacements, from the discrete one: v = u_D on Gamma_D and v^n <= g on all of
/// Gamma_C, not only at points.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// A facet is closed if T^n < 0 at all its contact points and open if T^n = 0 at all. It sticks if |T^t| <
/// S_h at all and slips if at none. Otherwise it is in transition. Degrees of freedom as in the space;
/// absent, for `reason` or because `excess` would be too large.
struct AdmissibleDisplacements
{
  std::optional<std::vector<double>> open;    ///< facets in transition taken as open, as slipping
  std::optional<std::vector<double>> closed;  ///< as closed, as sticking
  bool has_transition = false;                ///< on any rank; if false, both are the same
  /// Largest |g - g_h| at the contact points, g_h of degree p with the values of g at the nodes: v is
  /// admissible for g_h.
  double gap_remainder = 0;
  double direction_remainder = 0;  ///< largest |N - M N_0| there
  /// Largest coefficient of v^n - g_h in Bernstein's basis on a facet, recomputed from v: at most 1e-14 max
  /// |u|, |g| for a displacement that is given.
  double excess_open = 0;
  double excess_closed = 0;
  std::string reason{};  ///< why there is none; empty: no objection
};

/// v equals u except on Gamma_C. There its coefficients in Bernstein's basis, the control points, are those
/// of u, moved. Facets share the control points on their edges and vertices. On each facet
///     v^n = g_h if it or, at shared ones, one of the facets is closed, else v^n <= g_h;
///     v^t = w_h if it or one of the facets sticks, w_h of the slip before this load step, else as in u;
/// they never move along axes that Gamma_D fixes. Between bodies [v] takes the place of v; the slaves move,
/// or the masters where slaves are fixed. Where facets with different normals meet:
/// certify/energy/control_point.h; where meshes do not match: certify/energy/kept_apart.h. The basis is
/// nonnegative and adds up to 1, so what holds for the coefficients holds for v.
///
/// t is T(u) at the contact points of the form. If obstacles_unfit() objects, `reason` says why. All ranks
/// together.
template <int dim>
[[nodiscard]] AdmissibleDisplacements admissible_displacements(const contact::NitscheForm<dim>& form,
                                                               std::span<const double> u,
                                                               std::span<const Point<dim>> t);

/// The segments whose facets are in transition, where the state of contact changes; t as above.
template <int dim>
[[nodiscard]] std::vector<std::size_t> facets_in_transition(const contact::NitscheForm<dim>& form,
                                                            std::span<const Point<dim>> t);

}  // namespace tribound::certify
