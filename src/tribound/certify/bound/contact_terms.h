#pragma once

/// @file contact_terms.h
/// The components of the bound on the contact boundary, method section 5.

#include <array>
#include <span>
#include <vector>

#include "tribound/certify/bound/kinks.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

enum class ContactRule
{
  resolved,
  reference
};

/// Squares of the components on one segment k; Pi_k is the projection on P^p(k)^d by the points of the rule.
struct ContactSquares
{
  double cnt = 0;    ///< h_k ||[P^n]_- - Pi_k [P^n]_-||_k^2
  double frc = 0;    ///< h_k ||[P^t]_S - Pi_k [P^t]_S||_k^2
  double lin2n = 0;  ///< h_k ||Pi_k (t^k - T_delta)^n||_k^2
  double lin2t = 0;  ///< h_k ||Pi_k (t^k - T_delta)^t||_k^2
  double reg2n = 0;  ///< h_k ||Pi_k (T_delta - T)^n||_k^2
  double reg2t = 0;  ///< h_k ||Pi_k (T_delta - T)^t||_k^2
};

/// Evaluates them. T(u) has kinks where P^n or |P^t| - S_h changes sign, and no rule of fixed order
/// integrates across a kink; ContactRule::resolved subdivides such facets, the pieces with a kink again and
/// again, until the value settles. In 3D it also subdivides where the contact slips. ContactRule::reference
/// takes the reference rule as it is.
template <int dim>
class ContactTerms
{
 public:
  ContactTerms(const contact::NitscheForm<dim>& form, ContactRule rule);

  using Tractions = typename Stress<dim>::Tractions;

  /// On segment k of the form for the iterate u.
  [[nodiscard]] ContactSquares operator()(int k, std::span<const double> u, const Tractions& t) const;
  /// lin2n and lin2t alone; the others are 0.
  [[nodiscard]] ContactSquares linearisation(int k, const Tractions& t) const;
  /// Coefficients of Pi_k t in the orthonormal basis of the reference simplex, t given at the contact points
  /// of segment k.
  [[nodiscard]] std::vector<Point<dim>> project(std::span<const Point<dim>> t) const;

 private:
  using FacetPoint = Point<dim - 1>;
  using Piece = fem::Part<dim - 1>;  ///< of the segment, in its coordinates

  /// Vector polynomials of degree p on a segment in the orthonormal basis of the reference simplex.
  struct Fields
  {
    std::vector<Point<dim>> augmented;  ///< {sigma(u)} - gamma [u]: P(u) without the gap
    std::vector<Point<dim>> dis;        ///< Pi_k T
  };
  /// Integrals over a part of the reference simplex.
  struct Integrals
  {
    double normal = 0;      ///< of ([P^n]_- - Pi_k [P^n]_-)^2
    double tangential = 0;  ///< of |[P^t]_S - Pi_k [P^t]_S|^2
    Kinks kinks{};          ///< up to what gap and threshold leave out
    double round_off = 0;   ///< of P, at most

    Integrals& operator+=(const Integrals& other)
    {
      normal += other.normal;
      tangential += other.tangential;
      return *this;
    }
  };

  /// A piece halved along each edge.
  struct Halved
  {
    std::size_t part;  ///< number of the part of the segment
    std::array<Piece, 1 << (dim - 1)> pieces;
    std::array<Integrals, 1 << (dim - 1)> values;
    double change;  ///< of the integrals, and what no point has seen
  };

  /// Those at the points of segment k.
  [[nodiscard]] std::span<const Point<dim>> on_segment(std::span<const Point<dim>> t, int k) const
  {
    const auto n = static_cast<std::size_t>(form_.n_segment_points());
    return t.subspan(k * n, n);
  }
  [[nodiscard]] Fields fields(int k, std::span<const double> u, const Tractions& t) const;
  [[nodiscard]] Integrals integrate(int k, const Fields& fields, const Piece& piece) const;
  void add_part(const contact::ContactSegment<dim>& segment, const contact::ContactDatumPart<dim>& part,
                const Integrals& integrals, ContactSquares& squares) const;
  [[nodiscard]] Halved halve(int k, const Fields& fields, std::size_t part, const Piece& piece,
                             const Integrals& whole) const;
  void settle(int k, const Fields& fields, std::span<const contact::ContactDatumPart<dim>> parts,
              std::span<Integrals> integrals) const;

  const contact::NitscheForm<dim>& form_;
  ContactRule rule_;
  std::vector<double> theta_;  ///< basis at the points of the rule, [q * n + i]
  int n_;                      ///< dim P^p(k)
  KinkFinder<dim> kinks_;      ///< for P^{p+2}, in which P^n is up to the remainder of the gap
};

}  // namespace tribound::certify
