#pragma once

/// @file initial_stress.h
/// The initial stress sigma_0 as the discrete problem on a mesh sees it, method section 16.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/datum.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/contact/nitsche/segment_values.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// sigma_0 in a region, by sums of squares: entries that stand twice in the tensor are multiplied by 2^{1/2}.
template <int dim>
[[nodiscard]] Datum<dim, problem::n_symmetric<dim>> initial_stress_datum(const problem::Problem<dim>& problem,
                                                                         int region);

/// The entry of sigma_0 around the axis of an axisymmetric problem; without terms for others.
template <int dim>
[[nodiscard]] Datum<dim, 1> initial_hoop_datum(const problem::Problem<dim>& problem, int region);

/// What is lost when sigma_0 is replaced by its projection on P^p on a cell, of axisymmetric problems on
/// P^{p+1} and without the weight r.
struct StressRemainder
{
  double oscillation = 0;  ///< >= ||sigma_0 - Pi sigma_0||, Pi with the moments by rules
  double projection = 0;   ///< >= the distance of Pi by rules from the exact one; 0 for polynomials

  /// An upper bound of ||q - sigma_0 + Pi^p sigma_0|| for a q in P^p of this norm. Exact moments leave what
  /// is orthogonal to q.
  [[nodiscard]] double added_to(double norm) const;
};

/// The moments of sigma_0 against P^{p+1} on every cell: form, patches and estimators see no others.
template <int dim>
class InitialStress
{
 public:
  /// Formulas that are not polynomials of degree p + 2 are subdivided until a cell T leaves out about
  /// density |T|^{1/2}, into max_parts parts at most. Keeps a reference to the mesh.
  InitialStress(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree, double density,
                int max_parts);

  [[nodiscard]] bool acts_on(Index cell) const
  {
    return !of_region_.empty() && acts_[mesh_->region(cell)] != 0;
  }
  /// The coefficients of Pi^{p+1} sigma_0 in fem::orthonormal_values on the reference simplex; those that are
  /// missing at the end are 0. Empty where it does not act.
  [[nodiscard]] std::span<const Tensor<dim>> coefficients(Index cell) const { return of(cell).plane; }
  /// The same of the entry around the axis of an axisymmetric problem.
  [[nodiscard]] std::span<const double> hoop_coefficients(Index cell) const { return of(cell).hoop; }
  [[nodiscard]] StressRemainder remainder(Index cell) const
  {
    return remainders_.empty() ? StressRemainder{} : remainders_[cell];
  }
  /// How many own cells were subdivided, and the number of their parts.
  [[nodiscard]] std::int64_t subdivided() const { return subdivided_; }
  [[nodiscard]] std::int64_t parts() const { return parts_; }

 private:
  struct Coefficients
  {
    std::vector<Tensor<dim>> plane{};
    std::vector<double> hoop{};  ///< empty unless the problem is axisymmetric
  };
  [[nodiscard]] const Coefficients& of(Index cell) const;
  void represent_constants(const problem::Problem<dim>& problem);
  void represent(const problem::Problem<dim>& problem, int degree, double density, int max_parts);
  /// Sets what moments of data are of a cell, and adds to its remainder.
  template <class Moments, class Datum, class Set>
  void represent(const Moments& moments, const Datum& datum, Index cell, double density, int max_parts,
                 const Set& set);

  const mesh::Mesh<dim>* mesh_;
  std::vector<char> acts_;                   ///< in the regions
  std::vector<Coefficients> of_region_;      ///< where it is constant; no regions: it acts nowhere
  std::vector<Coefficients> of_cell_;        ///< where it varies; empty: it does so nowhere
  std::vector<StressRemainder> remainders_;  ///< empty: all 0
  std::int64_t subdivided_ = 0;
  std::int64_t parts_ = 0;
};

/// {sigma_0} at the point of a segment with coordinates s.
template <int dim>
[[nodiscard]] Point<dim> initial_traction(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                          const ContactSegment<dim>& segment, const Point<dim - 1>& s);

/// I {sigma_0} on segments, I the interpolation at the nodes of P^p.
template <int dim>
class InitialTractions
{
 public:
  /// `points`: of the rule on segments. Throws InputError for a formula without bound on a segment, and for
  /// one that I changes where the law has a history. Nothing is kept by reference.
  InitialTractions(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                   std::span<const ContactSegment<dim>> segments, std::span<const Point<dim - 1>> points);

  /// Whether there are none.
  [[nodiscard]] bool empty() const { return at_nodes_.empty(); }
  /// On segment k at the points of the rule, a column for each.
  [[nodiscard]] Eigen::Matrix<double, dim, Eigen::Dynamic> at_points(std::size_t k) const;
  /// On segment k at the points with coordinates s.
  [[nodiscard]] std::vector<Point<dim>> at(std::size_t k, std::span<const Point<dim - 1>> s) const;
  /// An upper bound of the largest |{sigma_0} - I {sigma_0}| on segment k, from enclosures; functions that
  /// have none count as 0.
  [[nodiscard]] double deviation(std::size_t k) const { return deviations_.empty() ? 0 : deviations_[k]; }

 private:
  SegmentNodes<dim> nodes_;
  int degree_;
  std::vector<Point<dim>> at_nodes_;  ///< of all segments; empty: 0
  std::vector<double> deviations_;    ///< of all segments; empty: 0
};

}  // namespace tribound::contact
