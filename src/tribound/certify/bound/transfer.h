#pragma once

/// @file transfer.h
/// What is lost where contact tractions pass between meshes that do not match.

#include <functional>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

/// A traction on a part of a facet: sum_i c_i theta_i(s), s the reference coordinates of the part and theta_i
/// the orthonormal polynomials of degree p on the reference simplex.
template <int dim>
struct TractionPiece
{
  fem::Part<dim - 1> part;  ///< of the reference facet
  std::vector<Point<dim>> coefficients;
};

/// The facet F of a cell T with apex a carries the tractions q on its parts, and none beside them; an
/// equilibrated stress carries Pi_F q, the projection on P^p(F)^d. With r = q - Pi_F q there is a tau on T
/// with div tau = 0, tau n = r on F and 0 on the other facets, so that (r, v)_F = (tau, grad v)_T: the result
/// is
/// ||tau||_T or more. With H = d |T| / |F|, x = (1 - z) xi + z a, xi in F, a_F the foot of a in the plane of
/// F, div_F rho = r and rho . nu = 0 on the rim of F, row by row,
///
///     tau = (1 - z)^(m + 1 - d) { r n + [(xi - a_F) r - m rho] / H }   for any integer m >= 1,
///     ||tau||_T^2 = H / (2 m + 2 - d) int_F |r|^2 + |(xi - a_F) r - m rho|^2 / H^2.
///
/// 2D: rho is the integral of r along F; parts may overlap, then tractions add up. 3D: ||rho|| <= h_F/pi
/// ||r||, for parts that do not overlap. The smallest over m <= 64.
template <int dim>
[[nodiscard]] double transfer_norm(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                                   std::span<const TractionPiece<dim>> pieces);

/// In 2D the smallest ||s + tau||_T^2 - ||s||_T^2 over some of these m, for a field s of degree `degree` on
/// the cell, given by its value at a reference point.
[[nodiscard]] double transfer_change(const mesh::Mesh<2>& mesh, const mesh::BoundaryFacet& facet, int degree,
                                     std::span<const TractionPiece<2>> pieces,
                                     const std::function<Tensor<2>(const Point<2>&)>& s);

}  // namespace tribound::certify
