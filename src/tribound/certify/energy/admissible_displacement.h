#pragma once

/// @file admissible_displacement.h
/// Displacements that are kinematically admissible, from the discrete one: v = u_D on Gamma_D, v^n <= g on
/// all of Gamma_C, not only at points.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// A facet is closed where T^n < 0 at all its contact points, open where T^n = 0 at all, sticks where |T^t| <
/// S_h at all and slips where it is at none; in between it is in transition. Degrees of freedom as in the
/// space; absent: there is none, for `reason` or because `excess` would be too large.
struct AdmissibleDisplacements
{
  std::optional<std::vector<double>> open;    ///< facets in transition taken for open, for slipping
  std::optional<std::vector<double>> closed;  ///< for closed, for sticking
  bool has_transition = false;                ///< on any rank; if not, both are the same
  /// Largest |g - g_h| at the contact points, g_h of degree p with the values of g at the nodes: v is
  /// admissible for g_h.
  double gap_remainder = 0;
  /// Largest coefficient of v^n - g_h in Bernstein's basis on a facet, recomputed from v: at most 1e-14 max
  /// |u|, |g| for what is given.
  double excess_open = 0;
  double excess_closed = 0;
  std::string reason{};  ///< why there can be none, in words; empty: nothing speaks against it
};

/// v equals u but on Gamma_C. There its coefficients in Bernstein's basis, control points, are those of u
/// moved so that on each facet, all of whose coefficients are control points of edges and vertices that
/// others share,
///     v^n = g_h if it or, at shared ones, one of the facets is closed, else v^n <= g_h;
///     v^t = 0 if it or one of the facets sticks, else as in u;
/// never along axes that Gamma_D fixes; between bodies [v] in the place of v, the slaves being moved, or
/// masters where these are fixed. Where facets of different normals meet: certify/energy/control_point.h. The
/// basis is nonnegative and adds up to 1, so that what holds for coefficients holds for v.
///
/// t is T(u) at the contact points of the form. Of contact along constant directions, between bodies on
/// meshes that match, without bond and water; else `reason` says what there is. All ranks together.
template <int dim>
[[nodiscard]] AdmissibleDisplacements admissible_displacements(const contact::NitscheForm<dim>& form,
                                                               std::span<const double> u,
                                                               std::span<const Point<dim>> t);

/// The segments on which the state of contact changes, facets in transition; t as above.
template <int dim>
[[nodiscard]] std::vector<std::size_t> facets_in_transition(const contact::NitscheForm<dim>& form,
                                                            std::span<const Point<dim>> t);

}  // namespace tribound::certify
