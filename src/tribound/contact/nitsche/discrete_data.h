#pragma once

/// @file discrete_data.h
/// The data of a problem as the discrete problem on a mesh sees them: loads, gaps, thresholds and water
/// pressures at the points of the reference rules. They are the same for form, residual, patches and
/// estimators, and come with bounds of what that leaves out.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "tribound/contact/nitsche/datum_moments.h"
#include "tribound/contact/nitsche/initial_stress.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// What is lost when a load on one cell or facet is replaced by its values at the points of a rule.
struct LoadRemainder
{
  /// >= ||f - Pi f||: P^{p-1} on cells, P^p on facets; on cells of axisymmetric problems >= ||f - f_h||.
  double oscillation = 0;
  double mean = 0;  ///< >= |integral of f - its value by the rule|, also times affine weights of size 1
};

/// A part of a contact segment on which a rule integrates gap, threshold and water pressure, up to the
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

/// What data that are not polynomials may add to the bound, stress times length^(dim/2).
struct DataAccuracy
{
  double share = 1e-4;               ///< of the largest effect that the data can have
  std::optional<double> absolute{};  ///< replaces the share
};

/// How finely the data were subdivided.
struct DataEffort
{
  /// Cells, boundary facets and contact segments with data that are not polynomials of degree p + 2.
  std::int64_t formulas = 0;
  std::int64_t loads = 0;       ///< those of them whose data are loads
  std::int64_t subdivided = 0;  ///< those of them that were subdivided
  std::int64_t parts = 0;       ///< the number of parts of these
  std::int64_t unenclosed = 0;  ///< cells and facets with functions that are known only at points
};

/// The degree to which the rules for data are exact: data_quadrature_degree(p), of axisymmetric problems
/// data_quadrature_degree(p + 4), since with the weight r there are products with r, and quotients by it.
template <int dim>
[[nodiscard]] int data_exactness(const problem::Problem<dim>& problem, int degree);

/// Values are given at the points of the rules exact to data_exactness(), in the order of the rule in the
/// reference coordinates of Mesh::cell; on contact segments in their own coordinates. If a formula is
/// subdivided, they are those of the polynomial of degree p + 1 with the same moments. A threshold is not
/// below 0, and a gap not below its smallest value: its polynomial is made flatter, with the same mean.
/// Boundary facets have their numbers in Mesh::boundary(). Keeps references to problem and mesh. Several
/// ranks construct it together; ghosts have data, too.
template <int dim>
class DiscreteData
{
 public:
  /// Subdivides until what is left out adds no more than about `accuracy` to the bound; gaps count as the
  /// stress gamma g. Throws InputError for a negative threshold or water pressure and for data that are not
  /// finite, and names the place. Without segments only loads are known.
  DiscreteData(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree,
               std::span<const ContactSegment<dim>> segments, const DataAccuracy& accuracy = {});

  [[nodiscard]] const problem::Problem<dim>& problem() const { return problem_; }
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
  /// Of an axisymmetric problem: f_h on a cell, which has these values, in the orthonormal basis of P^{p+6}
  /// of the reference cell; of a constant f only the first coefficient.
  [[nodiscard]] std::vector<Point<dim>> body_polynomial(Index cell) const;
  /// g_N on a boundary facet; fixed components are 0.
  void traction(std::size_t facet, std::span<Point<dim>> values) const;
  /// The data at the point with coordinates s on segment k.
  [[nodiscard]] ContactData contact(const ContactSegment<dim>& segment, std::size_t k,
                                    const Point<dim - 1>& s) const;

  [[nodiscard]] const InitialStress<dim>& initial_stress() const { return *initial_stress_; }

  [[nodiscard]] LoadRemainder body_remainder(Index cell) const
  {
    return body_.remainders.empty() ? LoadRemainder{} : body_.remainders[cell];
  }
  [[nodiscard]] LoadRemainder traction_remainder(std::size_t facet) const
  {
    return traction_.remainders.empty() ? LoadRemainder{} : traction_.remainders[facet];
  }
  /// In the coordinates of the segment; empty if gap, threshold and water are integrated exactly on the whole
  /// segment.
  [[nodiscard]] std::span<const ContactDatumPart<dim>> contact_parts(std::size_t segment) const;
  /// What data that are not polynomials may add to the bound on a contact segment, divided by the root of its
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

  /// The measures of the body, its boundary and the contact boundary.
  struct Measures
  {
    double body;
    double boundary;
    double contact;
  };

  using Segments = std::span<const ContactSegment<dim>>;

  [[nodiscard]] Measures measures(Segments segments) const;
  void count_formulas(Segments segments);
  // `density`: what a cell or facet may leave out, divided by the root of its measure.
  void represent_body_forces(double density);
  void represent_tractions(double density);
  void represent_initial_stress(double density);
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
  int max_parts_ = 0;  ///< for a cell or facet
  double contact_density_ = 0;
  Represented<dim> body_;
  Represented<dim> traction_;
  Represented<3> contact_;
  std::shared_ptr<const InitialStress<dim>> initial_stress_;
  std::unordered_map<std::size_t, std::vector<ContactDatumPart<dim>>> contact_parts_;
  DataEffort effort_;
};

}  // namespace tribound::contact
