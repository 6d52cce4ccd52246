#pragma once

/// @file pairing.h
/// Which facets lie opposite each other: the overlay of two boundaries whose meshes need not match.

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
/// where F is the slave facet of x, n are outward normals, and |e| = 1. Each F is cut into simplices that lie
/// opposite one G each, on which Pi is affine; points without a partner are in none. |l| <= reach is tested
/// at the centroid of the common part of F and G. Corners within 1e-12 of an edge, in barycentric
/// coordinates, count as on it: form and certificate use the same segments, so this rounding changes the
/// problem slightly but not the guarantee. So does this: facets whose corners lie opposite each other within
/// 1e-6 of the slave facet, as in meshes read from files with few digits, are opposite corner by corner.
/// Ordered by slave facets, then by the places of the master facets.
/// O(n log n).
///
/// On a distributed mesh, after with_partners(): the complete pairs of the slave and master facets of cells
/// with a patch vertex, the same on all ranks, and a part of the pairs of others.
///
/// Throws InputError if e.n_F <= 0.1, and if two master facets are equally far or their order changes: the
/// pairing is then ambiguous. `where` is for messages.
template <int dim>
[[nodiscard]] std::vector<FacetPair<dim>> overlay(const mesh::Mesh<dim>& mesh,
                                                  std::span<const std::size_t> slave,
                                                  std::span<const std::size_t> master,
                                                  const problem::Pairing<dim>& pairing = {},
                                                  const Where& where = {});

}  // namespace tribound::contact
