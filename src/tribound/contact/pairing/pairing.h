#pragma once

/// @file pairing.h
/// What lies opposite what: the overlay of two boundaries whose meshes need not match.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A boundary facet, or the part of it with the given corners.
template <int dim>
struct FacetPart
{
  std::size_t number;  ///< in Mesh::boundary()
  std::optional<fem::Part<dim - 1>> part{};
};

/// A part of a slave facet, and the part of a master facet onto which Pi takes it corner by corner.
template <int dim>
struct FacetPair
{
  FacetPart<dim> slave;
  FacetPart<dim> master;
};

/// The overlay of the boundary facets with the given numbers, in the undeformed configuration:
///
///     Pi(x) = x + l(x) e on the facet G of the master with the smallest |l| among those with
///     n_G.n_F < -0.1, n_G.e < -0.1 and |l| <= reach,
///
/// F the slave facet of x, n outward normals, |e| = 1. Each F is cut into simplices that lie opposite one G
/// each, on which Pi is affine; points without a partner are in none. |l| <= reach is asked of the centroid
/// of what F and G have in common. Corners within 1e-12 of an edge, in barycentric coordinates, count as on
/// it: form and certificate use the same segments, so that rounding here moves the problem by as much and
/// harms no guarantee. In the order of the slave facets, then of the places of the master's. O(n log n).
///
/// Of a mesh that is shared out, after with_partners(): what slave or master facets of cells with a patch
/// vertex have, the same on all ranks, and parts of what others have.
///
/// InputError where e.n_F <= 0.1, and where two master facets are equally far or change their order: the
/// pairing is then ambiguous. `where` is for messages.
template <int dim>
[[nodiscard]] std::vector<FacetPair<dim>> overlay(const mesh::Mesh<dim>& mesh,
                                                  std::span<const std::size_t> slave,
                                                  std::span<const std::size_t> master,
                                                  const problem::Pairing<dim>& pairing = {},
                                                  const Where& where = {});

}  // namespace tribound::contact
