#pragma once

/// @file contact_terms.h
/// The components of the bound on the contact boundary, method section 5.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tribound/certify/bound/kinks.h"
#include "tribound/certify/equilibrate/small_dense.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/simplex_parts.h"

namespace tribound::certify
{

enum class ContactRule
{
  resolved,
  reference
};

/// Squares of the components on one segment k; Pi_k is the projection on P^p(k)^d by the points of the rule,
/// both it and the norms with the weight of the problem.
struct ContactSquares
{
  double cnt = 0;    ///< h_k ||[P^n]_- - Pi_k [P^n]_-||_k^2
  double frc = 0;    ///< h_k ||[P^t]_S - Pi_k [P^t]_S||_k^2
  double lin2n = 0;  ///< h_k ||Pi_k (t^k - T_delta)^n||_k^2
  double lin2t = 0;  ///< h_k ||Pi_k (t^k - T_delta)^t||_k^2
  double reg2n = 0;  ///< h_k ||Pi_k (T_delta - T)^n||_k^2
  double reg2t = 0;  ///< h_k ||Pi_k (T_delta - T)^t||_k^2
};

/// Evaluates these components. T(u) has kinks where P^n or |P^t| - S_h changes sign, and no rule of fixed
/// order integrates across a kink. ContactRule::resolved subdivides such facets, and pieces with a kink
/// again, until the value settles. In 3D it also subdivides where the contact slips. ContactRule::reference
/// uses the reference rule without subdivision.
///
/// Where N varies, let |N - N'| <= rho on a piece K for some N' in P^2. With A = {sigma(u)} - gamma [u], P^n
/// = A.N + gamma g and Pi_k T.N are in P^{p+2} up to (|A| + |Pi_k T|) rho. With f' in P^{p+2} and the
/// projection Pi f of the values of f at the points, ||f - Pi f|| <= 2 ||f - f'|| in the norms on K and of
/// the rule. So the rule computes ||f|| up to 3 rho (||A||_K + ||Pi_k T||_K), where both norms are exact. In
/// 2D the same holds along the tangent; in 3D P^t = A - A.N N is in P^{p+2} up to rho (2 + rho) |A| with rho
/// for N' in P^1. Pieces are halved until that is negligible. The kinks are those of Pi f, which differs from
/// f by no more.
///
/// On the meridian of an axisymmetric problem A contains u_r / r: it is no polynomial, but r A is one of
/// degree p + 1. So the polynomials are those of m A, m Pi_k T, m P and m S, which have the kinks of T; m = r
/// on segments off the axis. A segment that touches the axis has m = 1, because u_r / r is a polynomial
/// there. The weight of |m T|^2 is r / m^2: where this is 1 / r, the rule misses at most
/// inverse_radius_error() of the squares, and segments are cut so that this is negligible.
template <int dim>
class ContactTerms
{
 public:
  ContactTerms(const contact::NitscheForm<dim>& form, ContactRule rule);

  using Tractions = typename Stress<dim>::Tractions;

  /// The components on segment k of the form for the iterate u.
  [[nodiscard]] ContactSquares operator()(int k, std::span<const double> u, const Tractions& t) const;
  /// lin2n and lin2t alone; the others are 0.
  [[nodiscard]] ContactSquares linearisation(int k, const Tractions& t) const;
  /// Coefficients of m Pi_k t in the orthonormal basis of the reference simplex, t given at the contact
  /// points of segment k.
  [[nodiscard]] std::vector<Point<dim>> project(int k, std::span<const Point<dim>> t) const;
  /// Those of the projection on P^p without weight, of any problem.
  [[nodiscard]] std::vector<Point<dim>> project_plainly(std::span<const Point<dim>> t) const;

 private:
  using FacetPoint = Point<dim - 1>;
  using Piece = fem::Part<dim - 1>;  ///< of the segment, in its coordinates

  static constexpr int n_halves = 1 << (dim - 1);
  static constexpr int max_n = fem::polynomial_dimension(dim - 1, fem::max_degree + (dim == 2 ? 1 : 0));

  /// Coefficients of m ({sigma(u)} - gamma [u]), which is P(u) without the gap, sigma_0 being interpolated,
  /// then of m Pi_k T.
  static constexpr int second = padded(dim);
  using Pair = DenseVector<2 * second>;
  [[nodiscard]] static Eigen::Map<const Point<dim>> augmented_of(const Pair& pair)
  {
    return Eigen::Map<const Point<dim>>(pair.data());
  }
  [[nodiscard]] static Eigen::Map<const Point<dim>> dis_of(const Pair& pair)
  {
    return Eigen::Map<const Point<dim>>(pair.data() + second);
  }
  /// Vector polynomials of degree p (axisymmetric: p + 1) on a piece, in the orthonormal basis of the
  /// reference simplex in the coordinates of the piece.
  using Fields = std::array<Pair, max_n>;
  /// Squares of the possible increase of norms where N is not a polynomial.
  struct Missed
  {
    double normal = 0;
    double tangential = 0;
  };
  /// Integrals over a part of the reference simplex.
  struct Integrals
  {
    double normal = 0;      ///< of ([P^n]_- - Pi_k [P^n]_-)^2
    double tangential = 0;  ///< of |[P^t]_S - Pi_k [P^t]_S|^2
    Missed missed{};
    Missed missed_open{};  ///< where P^n > 0 all over
    Kinks kinks{};         ///< of m T, up to the remainders of gap, threshold and N
    double round_off = 0;  ///< upper bound of that of P
    double deviation = 0;  ///< of m P^n from polynomials, as far as N causes it
    problem::NormalDeviation of_normal{};

    Integrals& operator+=(const Integrals& other)
    {
      normal += other.normal;
      tangential += other.tangential;
      missed.normal += other.missed.normal;
      missed.tangential += other.missed.tangential;
      missed_open.normal += other.missed_open.normal;
      missed_open.tangential += other.missed_open.tangential;
      return *this;
    }
  };

  /// A part of a segment on which the data are smooth.
  struct Part
  {
    contact::ContactDatumPart<dim> data;
    Fields fields;
    Integrals integrals;
  };

  /// A piece whose edges are halved.
  struct Halved
  {
    std::size_t part;  ///< number of the part of the segment
    std::array<Piece, n_halves> pieces;
    std::vector<Fields> fields;
    std::vector<Integrals> values;
    double change;  ///< of the integrals, plus what no point has seen
  };

  /// The values at the points of segment k.
  [[nodiscard]] std::span<const Point<dim>> on_segment(std::span<const Point<dim>> t, int k) const
  {
    const auto n = static_cast<std::size_t>(form_.n_segment_points());
    return t.subspan(k * n, n);
  }
  /// Whether m = r; else 1.
  [[nodiscard]] bool is_scaled(int k) const;
  [[nodiscard]] static double scale(bool is_scaled, const Point<dim>& x) { return is_scaled ? x[0] : 1.0; }
  /// Upper bounds on a piece.
  struct Largest
  {
    double scale = 1;          ///< m
    double weight = 1;         ///< of the integrals
    double square_weight = 1;  ///< weight / m^2
    double missed = 0;         ///< by the rule of the integral of a square with that weight, relative to it
  };
  [[nodiscard]] Largest largest_on(int k, const Piece& piece) const;
  /// The orthogonal projection of values at the contact points.
  [[nodiscard]] std::vector<Point<dim>> coefficients_of(std::span<const Point<dim>> values) const;
  /// project() on a segment of an axisymmetric problem.
  [[nodiscard]] std::vector<Point<dim>> weighted_projection(int k, std::span<const Point<dim>> t) const;
  /// Halves parts until the rule integrates the quotients by r there.
  void resolve_radius(int k, std::vector<Part>& parts) const;
  /// Adds h_k ||(Pi_k t)^n||_k^2 and h_k ||(Pi_k t)^t||_k^2.
  void add_traction(int k, std::span<const Point<dim>> t, double& normal, double& tangential) const;
  /// Upper bounds of the same where N or the weight varies, from the coefficients of m Pi_k t.
  void add_varying_traction(int k, std::span<const Point<dim>> coefficients, double& normal_part,
                            double& tangential_part) const;
  [[nodiscard]] Fields fields(int k, std::span<const double> u, const Tractions& t) const;
  [[nodiscard]] std::vector<double> coefficients_on(const Piece& part) const;
  /// The fields with other coefficients: [i * n + j] takes i to j.
  [[nodiscard]] Fields changed(const Fields& fields, std::span<const double> coefficients) const;
  /// The fields of a piece in the coordinates of one of its halves.
  [[nodiscard]] Fields on_half(const Fields& whole, std::size_t half) const
  {
    const std::size_t size = to_half_.size() / n_halves;
    return changed(whole, std::span(to_half_).subspan(half * size, size));
  }
  /// The integrals over pieces of segment k with their fields, together because formulas are then evaluated
  /// faster. `known`: the deviation of N on a larger piece; computed if absent.
  void integrate(int k, std::span<const Fields> fields, std::span<const Piece> pieces,
                 std::span<Integrals> results,
                 const std::optional<problem::NormalDeviation>& known = {}) const;
  /// The points of the rule on a piece, and the data there.
  struct PointsOnPiece;
  [[nodiscard]] Integrals integrate(int k, const Fields& fields, const Piece& piece, PointsOnPiece points,
                                    const std::optional<problem::NormalDeviation>& known) const;
  /// Sets what is missed if N is not a polynomial on the piece, from m A, m Pi_k T and the weights of their
  /// squares at the points, and the kinks there.
  void add_missed(int k, const Piece& piece, std::span<const Point<dim>> augmented,
                  std::span<const Point<dim>> dis, std::span<const double> weights,
                  Integrals& integrals) const;
  /// With what the interpolation of the initial stress may add to cnt and frc.
  [[nodiscard]] ContactSquares with_initial_deviation(int k, ContactSquares squares) const;
  /// Halves parts until the deviation of N from polynomials is negligible on each.
  void resolve_normal(int k, std::vector<Part>& parts) const;
  /// Whether P^n > 0 on a part for any gap and N between the points.
  [[nodiscard]] bool is_open(int k, const Part& part) const;
  void add_part(int k, const Part& part, ContactSquares& squares) const;
  [[nodiscard]] Halved halve(int k, const Fields& fields, std::size_t part, const Piece& piece,
                             const Integrals& whole) const;
  void settle(int k, std::span<Part> parts) const;

  const contact::NitscheForm<dim>& form_;
  ContactRule rule_;
  std::vector<double> theta_;    ///< basis at the points of the rule, [q * n + i]
  int degree_;                   ///< of the fields
  int n_;                        ///< dim P^degree(k)
  std::vector<double> to_half_;  ///< coefficients_on() the halves of the reference simplex
  KinkFinder<dim> kinks_;        ///< for degree + 2: contains m P^n up to the remainder of the gap
};

}  // namespace tribound::certify
