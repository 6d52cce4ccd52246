#pragma once

/// @file meridian_patch.h
/// The minimisation problems on the patch of one vertex of an axisymmetric problem.
///
/// With tau = r sigma, sigma_tt = div tau_r + r f_r needs no unknowns of its own, and the axial row alone has
/// an equation for its divergence. For each vertex a,
///     radial: int |tau - psi_a r sigma_r(u)|^2 / r + int r (s - psi_a sigma_tt(u))^2 -> min,
///             s = div tau + psi_a r f_r - r sigma_r(u).grad psi_a;
///     axial:  int |tau - psi_a r sigma_z(u)|^2 / r -> min,
///             div tau = -Pi (psi_a r f_z) + r sigma_z(u).grad psi_a + r y,
/// Pi the projection onto P^p, on cells with an edge on the axis that of MeridianCell::body, and
/// y = 0 if the component is fixed on a facet at a, otherwise the constant that lets the data agree. tau n is
/// 0 on the rim, continuous inside, what MeridianFacets has on the boundary, and free where the component is
/// fixed. The parts lin and reg have tractions in place of u and f.
///
/// Weakly symmetric stresses, which the bound of the energy error needs, are those of both rows together in
/// the norm of the compliance (weak_symmetry.h): (tau, W)_T = 0 for skew W in P^p, P^{p-1} on cells with an
/// edge on the axis. The axial row has the same equation, with (K_{T,a} (x - x_T))_z on the right, and s less
/// (K_{T,a} (x - x_T))_r.
///
/// With tau = psi_a r sigma(u) + d, B the divergence (weakly symmetric: of the axial row, and the skew part)
/// and N the normal traces, all of that is
///     M d + B^T eta + N^T mu = -h,   B d - C eta = k,   N d = g,
/// where C is the inverse of (r ., .) in the radial row, 0 in the axial row, and h, 0 row by row, is what
/// hoop stresses that do not follow from d do on it. On each cell d, eta and the multiplier of the rim are
/// eliminated; the multipliers of the facets at a are left.

#include <array>
#include <span>

#include "tribound/certify/equilibrate/meridian_facets.h"

namespace tribound::certify
{

/// A cell around the vertex.
struct MeridianPatchCell
{
  Index cell;
  const MeridianCell* prepared;
  std::array<std::span<double>, 3>
      stress{};  ///< of each part: where tau_a goes, as in Stress; empty: nowhere
};

/// Parts first_part, ..., end_part - 1 of the stress on the patch of a vertex. Throws SolveError naming the
/// place if rounding leaves none. The cells are prepared for patches of the kind.
void solve_meridian_patch(const mesh::Mesh<2>& mesh, const MeridianReference& reference,
                          const MeridianFacets& facets, Index vertex, int first_part, int end_part,
                          std::span<const MeridianPatchCell> cells, bool by_rows);

}  // namespace tribound::certify
