#pragma once

/// @file transfer.h
/// What is lost when contact tractions are transferred between non-matching meshes.

#include <algorithm>
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

/// Values at a point of a rule on a facet, in the notation of TransferLifting.
template <int dim>
struct TransferLoss
{
  Point<dim - 1> at;  ///< on the reference facet
  double weight;      ///< with the measure of the facet
  Point<dim> r;
  Tensor<dim> moved;  ///< (xi - a_F) r; in 3D less what rho / m can remove without changing div rho
  Tensor<dim> rho;    ///< the smallest
};

/// The facet F of a cell T with apex a carries the tractions q on its parts, and none outside them; an
/// equilibrated stress carries Pi_F q, the projection on P^p(F)^d. With r = q - Pi_F q there is a tau on T
/// with div tau = 0, tau n = r on F and 0 on the other facets, so that (r, v)_F = (tau, grad v)_T. Let H = d
/// |T| / |F|, x = (1 - z) xi + z a with xi in F, and a_F the foot of a in the plane of F. With div_F rho = r
/// and rho . nu = 0 on the rim of F, row by row,
///
///     tau = (1 - z)^(m + 1 - d) { r n + [(xi - a_F) r - m rho] / H }   for any integer m >= 1,
///     ||tau||_T^2 = H / (2 m + 2 - d) int_F |r|^2 + |(xi - a_F) r - m rho|^2 / H^2.
///
/// 2D: rho is the integral of r along F; where parts overlap, tractions add up. 3D, for parts that do not
/// overlap: rho is, for each m, the Brezzi-Douglas-Marini field of degree p + 1 on a triangulation of F
/// [BDM85] with the smallest ||tau||. m <= 64.
template <int dim>
class TransferLifting
{
 public:
  TransferLifting(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                  std::span<const TractionPiece<dim>> pieces);

  /// The smallest ||tau||_T. In 3D without a triangulation (`conforming_cover`), or if rounding spoils rho:
  /// the bound that follows from ||rho|| <= h_F / j_{1,1} ||r|| [LS10].
  [[nodiscard]] double norm() const { return norm_; }

  /// The smallest ||s + tau||_T^2 - ||s||_T^2 over some of these m, for a field s of degree p on the cell,
  /// given by its value at a reference point. Infinity without rho.
  [[nodiscard]] double change(const std::function<Tensor<dim>(const Point<dim>&)>& s) const;

 private:
  /// ||tau||_T^2.
  [[nodiscard]] double square(int m) const
  {
    return std::max(0.0, fixed_ + m * (linear_ + m * quadratic_)) / (2 * m + 2 - dim);
  }
  [[nodiscard]] int best_exponent() const;

  int local_;  ///< number of the facet in its cell
  int degree_;
  double height_;
  Point<dim> normal_;
  std::vector<TransferLoss<dim>> losses_;
  double fixed_ = 0;  ///< the terms of ||tau||^2, by powers of m
  double linear_ = 0;
  double quadratic_ = 0;
  double norm_;
};

/// ||r||_F alone.
template <int dim>
[[nodiscard]] double transfer_loss(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                                   std::span<const TractionPiece<dim>> pieces);

}  // namespace tribound::certify
