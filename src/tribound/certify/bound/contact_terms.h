#pragma once

/// @file contact_terms.h
/// The components of the bound on the contact boundary, method section 5.

#include <array>
#include <span>
#include <vector>

#include "tribound/certify/bound/kinks.h"
#include "tribound/certify/equilibrate/stress_tabulation.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

enum class ContactRule
{
  resolved,
  reference
};

/// Squares of the components on one segment, a whole facet F of Gamma_C.
struct ContactSquares
{
  double cnt = 0;    ///< h_F ||[P^n]_- - sigma_dis^n||_F^2
  double frc = 0;    ///< h_F ||[P^t]_S - sigma_dis^t||_F^2
  double lin2n = 0;  ///< h_F ||sigma_lin^n||_F^2
  double lin2t = 0;  ///< h_F ||sigma_lin^t||_F^2
  double reg2n = 0;  ///< h_F ||sigma_reg^n||_F^2
  double reg2t = 0;  ///< h_F ||sigma_reg^t||_F^2
};

/// Evaluates them. T(u) has kinks where P^n or |P^t| - S_h changes sign, and no rule of fixed order
/// integrates across a kink; ContactRule::resolved subdivides such facets, the pieces with a kink again and
/// again, until the value settles. In 3D it also subdivides where the contact slips. ContactRule::reference
/// takes the reference rule as it is.
template <int dim>
class ContactTerms
{
 public:
  /// Throws InputError for segments other than whole facets against rigid obstacles, on which the bound is
  /// not known.
  ContactTerms(const contact::NitscheForm<dim>& form, ContactRule rule);

  /// On segment k of the form for the iterate u.
  [[nodiscard]] ContactSquares operator()(int k, std::span<const double> u, const Stress<dim>& stress) const;
  /// lin2n and lin2t alone, from sigma_lin alone; the others are 0.
  [[nodiscard]] ContactSquares linearisation(int k, const Stress<dim>& stress) const;

 private:
  using FacetPoint = Point<dim - 1>;
  using Piece = fem::Part<dim - 1>;  ///< of the reference facet

  /// Vector polynomials of degree p on a facet in the orthonormal basis of the reference facet.
  struct Fields
  {
    std::vector<Point<dim>> augmented;  ///< sigma(u) n - gamma u: P(u) without the gap
    std::vector<Point<dim>> dis;        ///< sigma_dis n
  };
  /// Integrals over a part of the reference facet.
  struct Integrals
  {
    double normal = 0;      ///< of ([P^n]_- - sigma_dis^n)^2
    double tangential = 0;  ///< of |[P^t]_S - sigma_dis^t|^2
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
    std::size_t part;  ///< number of the part of the facet
    std::array<Piece, 1 << (dim - 1)> pieces;
    std::array<Integrals, 1 << (dim - 1)> values;
    double change;  ///< of the integrals, and what no point has seen
  };

  /// Coefficients of sigma n on the facet from those of sigma on its cell.
  [[nodiscard]] std::vector<Point<dim>> normal_trace(int k, std::span<const double> block) const;
  [[nodiscard]] Fields fields(int k, std::span<const double> u, const Stress<dim>& stress) const;
  [[nodiscard]] std::vector<Point<dim>> project(std::span<const Point<dim>> values) const;
  [[nodiscard]] Integrals integrate(int k, const Fields& fields, const Piece& piece) const;
  void add_part(const contact::ContactSegment<dim>& segment, const contact::ContactDatumPart<dim>& part,
                const Integrals& integrals, ContactSquares& squares) const;
  [[nodiscard]] Halved halve(int k, const Fields& fields, std::size_t part, const Piece& piece,
                             const Integrals& whole) const;
  void settle(int k, const Fields& fields, std::span<const contact::ContactDatumPart<dim>> parts,
              std::span<Integrals> integrals) const;

  const contact::NitscheForm<dim>& form_;
  ContactRule rule_;
  std::vector<StressTabulation<dim>>
      stress_table_;           ///< of the stress at the points of the facet rule, per local facet
  std::vector<double> theta_;  ///< basis on the facet there, [q * n + i]
  int n_;                      ///< dim P^p(F)
  KinkFinder<dim> kinks_;      ///< for P^{p+2}, in which P^n is up to the remainder of the gap
};

}  // namespace tribound::certify
