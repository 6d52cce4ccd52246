#pragma once

/// @file kept_apart.h
/// Displacements that keep bodies apart whose meshes do not match.

#include <span>
#include <vector>

#include "tribound/certify/energy/obstacle_facets.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// What is wanted on a segment: [v]^n = g, and [v]^t = w, the slip before this load step.
struct WantedContact
{
  bool closed = false;
  bool sticks = false;
};

/// The side of a pair that moves.
enum class MovedSide
{
  preferred,  ///< with the smaller modulus times diameter: moving it costs less, and a finer mesh fits better
  other
};

/// v = u - z, with z on that side of the segments that do not match. z is the sum of
///  - the mean over the facets around each node of the polynomials nearest to ([u]^n - g) n where `closed`,
///    plus [u]^t - w where `sticks`, in Bernstein's basis;
///  - a_j q_j, n . [q_j] >= 1 for the normals of all segments around j, a_j the smallest for which no
///    coefficient of [v]^n - g_h on segments is positive: coefficients of the second part on a segment are
///    means of those on its facet.
/// Nodes of tied bodies move together. Nothing moves along axes that Gamma_D fixes, so it may be impossible
/// where that side is fixed. All ranks together.
template <int dim>
[[nodiscard]] std::vector<double> kept_apart(const contact::NitscheForm<dim>& form,
                                             const ObstacleFacets<dim>& facets, MovedSide side,
                                             std::span<const WantedContact> wanted,
                                             std::span<const double> u);

}  // namespace tribound::certify
