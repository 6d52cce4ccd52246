#pragma once

/// @file discrete_data.h
/// The data of a problem as the discrete problem on a mesh sees them: loads, gaps, thresholds and water
/// pressures at the points of the reference rules, the same for form, residual, patches and estimators, with
/// bounds of what that leaves out.

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "tribound/contact/nitsche/datum_moments.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// What a load loses on one cell or facet when it is replaced by its values at the points of a rule.
struct LoadRemainder
{
  double oscillation = 0;  ///< >= ||f - Pi f||: P^{p-1} on cells, P^p on facets
  double mean = 0;  ///< >= |integral of f - what the rule makes of it|, also times affine weights of size 1
};

/// A part of a contact segment on which a rule integrates gap, threshold and the pressure of water, up to the
/// remainders: upper bounds of their distances from P^{p+2}.
template <int dim>
struct ContactDatumPart
{
  fem::Part<dim - 1> part;
  double gap;       ///< length
  double strength;  ///< stress
  double water;     ///< stress
};

/// What the discrete problem sees at a point of a contact segment.
struct ContactData
{
  double gap;       ///< g, length
  double strength;  ///< s >= 0 of the law, stress; 0 where it has none
  double water;     ///< p_w, stress; 0 without water
};

/// What the data that are no polynomials may leave out of the bound, stress times length^(dim/2).
struct DataAccuracy
{
  double share = 1e-4;               ///< of the largest effect that the data can have
  std::optional<double> absolute{};  ///< in its place
};

/// How far the data were looked into.
struct DataEffort
{
  /// Cells, boundary facets and contact segments with data that are no polynomials of degree p + 2.
  std::int64_t formulas = 0;
  std::int64_t loads = 0;       ///< of these, those whose data are loads
  std::int64_t subdivided = 0;  ///< of these
  std::int64_t parts = 0;       ///< into which these were cut
  std::int64_t unenclosed = 0;  ///< cells and facets with functions of which only values at points are known
};

/// Values are given at the points of the rules exact to data_quadrature_degree(p), in the order of the rule
/// in the reference coordinates of Mesh::cell, on contact segments in their own. Where a formula is
/// subdivided they are those of the polynomial of degree p + 1 with the same moments; a threshold is not
/// below 0, and a gap not below its smallest value: its polynomial is made flatter, with the same mean.
/// Boundary facets have their numbers in Mesh::boundary(). Keeps references to problem and mesh. On several
/// ranks, which construct it together, ghosts have data, too.
template <int dim>
class DiscreteData
{
 public:
  /// Subdivides until what is left out adds no more than about `accuracy` to the bound; gaps count with the
  /// stress gamma g. Throws InputError for a negative threshold or water pressure and for data that are not
  /// finite, naming the place. Without segments loads alone are known.
  DiscreteData(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree,
               std::span<const ContactSegment<dim>> segments, const DataAccuracy& accuracy = {});

  [[nodiscard]] const fem::Quadrature<dim>& cell_rule() const { return cell_moments_.rule(); }
  [[nodiscard]] const fem::Quadrature<dim - 1>& facet_rule() const { return facet_moments_.rule(); }

  [[nodiscard]] bool has_body_force(Index cell) const
  {
    return !problem_.body_force_is_zero(mesh_.region(cell));
  }
  [[nodiscard]] bool has_traction(std::size_t facet) const
  {
    return problem_.boundary(mesh_.boundary()[facet].tag).is_loaded();
  }
  /// f on a cell.
  void body_force(Index cell, std::span<Point<dim>> values) const;
  /// g_N on a boundary facet; fixed components are 0.
  void traction(std::size_t facet, std::span<Point<dim>> values) const;
  /// At the point with coordinates s on segment k.
  [[nodiscard]] ContactData contact(const ContactSegment<dim>& segment, std::size_t k,
                                    const Point<dim - 1>& s) const;

  [[nodiscard]] LoadRemainder body_remainder(Index cell) const
  {
    return body_.remainders.empty() ? LoadRemainder{} : body_.remainders[cell];
  }
  [[nodiscard]] LoadRemainder traction_remainder(std::size_t facet) const
  {
    return traction_.remainders.empty() ? LoadRemainder{} : traction_.remainders[facet];
  }
  /// In the coordinates of the segment; empty where gap, threshold and water are integrated exactly on all of
  /// it.
  [[nodiscard]] std::span<const ContactDatumPart<dim>> contact_parts(std::size_t segment) const;
  /// What data that are no polynomials may add to the bound on a contact segment, over the root of its
  /// measure.
  [[nodiscard]] double contact_density() const { return contact_density_; }
  [[nodiscard]] const DataEffort& effort() const { return effort_; }

 private:
  /// Data of n components on cells or on facets.
  template <int n>
  struct Represented
  {
    std::vector<LoadRemainder> remainders;                           ///< empty: all 0
    std::unordered_map<std::size_t, std::vector<Point<n>>> moments;  ///< where a formula is subdivided
  };

  /// Of the body, its boundary and the contact boundary.
  struct Measures
  {
    double body;
    double boundary;
    double contact;
  };

  using Segments = std::span<const ContactSegment<dim>>;

  [[nodiscard]] Measures measures(Segments segments) const;
  void count_formulas(Segments segments);
  // A cell or facet may leave out `density` times the root of its measure.
  void represent_body_forces(double density);
  void represent_tractions(double density);
  void represent_contact(Segments segments, double density);
  void check_signs(const ContactSegment<dim>& segment, const DatumOnSimplex<dim - 1, 3>& found) const;
  template <int k, int n>
  void keep(Represented<n>& represented, std::size_t index, bool is_owned, DatumOnSimplex<k, n>&& found);

  const problem::Problem<dim>& problem_;
  const mesh::Mesh<dim>& mesh_;
  int degree_;
  DatumMoments<dim, dim> cell_moments_;
  DatumMoments<dim - 1, dim> facet_moments_;
  DatumMoments<dim - 1, dim, 3> contact_moments_;
  double size_;        ///< of the bounding box
  int max_parts_ = 0;  ///< of a cell or facet
  double contact_density_ = 0;
  Represented<dim> body_;
  Represented<dim> traction_;
  Represented<3> contact_;
  std::unordered_map<std::size_t, std::vector<ContactDatumPart<dim>>> contact_parts_;
  DataEffort effort_;
};

}  // namespace tribound::contact
