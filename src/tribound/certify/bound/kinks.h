#pragma once

/// @file kinks.h
/// Where the contact traction may have a kink, also between the points of a rule.

#include <span>
#include <vector>

#include "tribound/fem/quadrature.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// The state of the bond of a law on a segment.
enum class Bond
{
  none,
  fresh,  ///< D = 0 all over
  damaged,
  broken  ///< D = 1 all over
};

/// What is known of T(u) on a piece of a contact facet.
struct Kinks
{
  bool possible = false;  ///< P^n or |P^t| - S_h may change sign
  bool slips = false;     ///< |P^t| may exceed S_h: in 3D T is then no polynomial, because P^t/|P^t| is none
  double hidden = 0;      ///< upper bound of the square of their values of the sign that no point has seen
  double lowest = 0;      ///< lower bound of P^n
};

/// Encloses P^n and |P^t| - S_h, given at the points of a rule, between Bernstein coefficients: P and the
/// strength of the law's friction cone are in P^degree. With b of P^t, l of S_h, and any unit vector e,
///     min (b.e - l) <= |P^t| - S_h <= max (|b| - l)
/// by P^t.e <= |P^t| and convexity; S_h = s - mu_F P^n is a polynomial if P^n < 0 everywhere on the piece.
/// Where N varies, P^n and, in 2D, the component of P^t along the tangent are polynomials up to the deviation
/// of N from P^2 (in 3D P^t from P^1). Then the projections of their values on P^degree are enclosed, which
/// ContactTerms accounts for.
///
/// For a law with a bond, P^t is what friction sees, with the remembered slip. If the bond is fresh and P
/// stays below its strength, T = P; if it is broken, T is that of friction; any other T may have kinks
/// anywhere.
template <int dim>
class KinkFinder
{
 public:
  KinkFinder(const fem::Quadrature<dim - 1>& rule, int degree);

  /// `normals`: N at the points, or one for all of them. Values of at most `noise`, the round-off of P, have
  /// no significant sign.
  [[nodiscard]] Kinks operator()(const problem::ContactLaw& law, std::span<const Point<dim>> normals,
                                 std::span<const Point<dim>> p, std::span<const double> strength, Bond bond,
                                 double noise) const;

  /// How much larger a coefficient can be than the values from which it is computed.
  [[nodiscard]] double amplification() const { return amplification_; }

 private:
  std::vector<double> to_bernstein_;  ///< [coefficient * n_points_ + point]
  int n_points_;
  double amplification_ = 0;
};

}  // namespace tribound::certify
