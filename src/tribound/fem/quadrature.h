#pragma once

/// @file quadrature.h
/// Quadrature with positive weights on the reference simplex {x >= 0, x_1 + ... + x_k <= 1}.

#include <vector>

#include "tribound/base/types.h"

namespace tribound::fem
{

/// sum_q weights[q] f(points[q]) = integral of f; the weights add up to 1/k!.
template <int k>
struct Quadrature
{
  std::vector<Point<k>> points;
  std::vector<double> weights;

  [[nodiscard]] int size() const { return static_cast<int>(weights.size()); }
};

/// A rule exact for polynomials of total degree <= `degree` on the k-simplex, k = 1, 2, 3: Gauss-Legendre for
/// k = 1, else a fully symmetric one ([WV15], [JS21]: symmetric_rules.h) up to degree 20 on the triangle and
/// 17 on the tetrahedron, and Gauss-Jacobi in collapsed coordinates above.
template <int k>
[[nodiscard]] Quadrature<k> quadrature(int degree);

/// The reference rule of method section 2 for contact, Neumann and body-force integrals is exact to this
/// degree.
[[nodiscard]] constexpr int data_quadrature_degree(int p)
{
  return 2 * p + 5;
}

}  // namespace tribound::fem
