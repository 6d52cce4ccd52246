#pragma once

/// @file datum_moments.h
/// A datum on one simplex as the method sees it, with a bound of what that leaves out.
///
/// A rule sees a formula only at its points and may miss what lies between them. Here the simplex is cut
/// where the formula jumps or kinks along a plane, and halved elsewhere, until ENCLOSURES of the formula show
/// that nothing of weight is left. On a part K, Taylor's theorem with interval coefficients gives delta with
/// |f - P| <= delta for a polynomial P of degree n. If a rule on K with positive weights is exact for the
/// integrals of P, it misses at most 2 delta |K| of the integral of f, and 2 delta |K|^{1/2} of its norm.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/datum.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/problem/formula.h"

namespace tribound::contact
{

/// A part of the simplex on which one rule integrates the datum.
template <int k, int n>
struct DatumPart
{
  fem::Part<k> part;
  Point<n> remainder;            ///< per component, >= the largest distance of f from P^{p+2}; 0 if unknown
  Point<n> mean_remainder;       ///< the same for P^{2p+4}
  std::vector<Point<n>> values;  ///< f at the points of the rule on the part
};

template <int k, int n>
struct DatumOnSimplex
{
  std::vector<DatumPart<k, n>> parts;
  /// (f, theta_j) / |T| on P^{p+1}, theta orthonormal on the reference simplex.
  std::vector<Point<n>> moments;
  double oscillation = 0;  ///< >= ||f - Pi f||, Pi the projection of the moments on the smaller space
  double mean = 0;         ///< >= |integral of f - its moment|

  /// Whether the rule on the whole simplex does not give the moments.
  [[nodiscard]] bool is_subdivided() const { return parts.size() > 1; }
};

/// The cost of what is left out: remainder * ||f - P|| + mean * |error of the integral of f|.
struct DatumWeights
{
  double remainder;
  double mean;
};

/// Computes moments of data for degree p of the method, with a rule exact to data_quadrature_degree(p) or
/// more.
template <int k, int dim, int n = dim>
class DatumMoments
{
 public:
  /// Oscillations are relative to P^projected.
  DatumMoments(int p, int projected) : DatumMoments(p, projected, fem::data_quadrature_degree(p)) {}
  /// With a rule exact to the given degree.
  DatumMoments(int p, int projected, int exact);

  /// Polynomials of degree <= p + 2 are integrated by the rule as it is. Others are subdivided until what is
  /// left out costs at most `allowed`, but into no more than about `max_parts` parts, unless the formula is
  /// not yet seen to be bounded. Throws InputError if a formula is not finite, and near points where the
  /// enclosures find no bound.
  [[nodiscard]] DatumOnSimplex<k, n> operator()(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map,
                                                const DatumWeights& weights, double allowed,
                                                int max_parts) const;

  /// The values at the points of the rule of the polynomial with the given moments.
  void evaluate(std::span<const Point<n>> moments, std::span<Point<n>> values) const;
  /// The same at one point of the simplex; missing moments are 0.
  [[nodiscard]] Point<n> evaluate(std::span<const Point<n>> moments, const Point<k>& s) const;

  [[nodiscard]] const fem::Quadrature<k>& rule() const { return rule_; }

 private:
  using Parts = std::vector<DatumPart<k, n>>;

  [[nodiscard]] Parts cut_at_switches(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map,
                                      int max_parts) const;
  void require_bounds(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map, const Parts& parts) const;
  void enclose(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map, DatumPart<k, n>& part) const;
  void refine(const Datum<dim, n>& datum, const SimplexMap<k, dim>& map, const DatumWeights& weights,
              double allowed, int max_parts, Parts& parts) const;
  [[nodiscard]] std::vector<Point<n>> moments(const Parts& parts) const;
  [[nodiscard]] double oscillation(const Parts& parts, std::span<const Point<n>> moments,
                                   double measure) const;

  int p_;
  int n_projected_;
  fem::Quadrature<k> rule_;
  int n_theta_;                ///< dim P^{p+1}
  std::vector<double> theta_;  ///< at the points of the rule, [q * n_theta + j]
};

}  // namespace tribound::contact
