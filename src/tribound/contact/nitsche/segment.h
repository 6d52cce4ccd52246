#pragma once

/// @file segment.h
/// The contact boundary in segments: parts of a facet of the body, each with its counterpart, a rigid
/// obstacle or one facet of a body. All contact integrals are sums over segments.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/contact/pairing/pairing.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/twin_facets.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// One side of a segment: a boundary facet or a part of one.
template <int dim>
struct SegmentSide
{
  mesh::BoundaryFacet facet;
  std::size_t number = 0;  ///< of the facet in Mesh::boundary()
  /// Corners in the coordinates of the reference facet, which mesh::facet_to_cell() maps to the cell; absent:
  /// the whole facet. Corner i of the slave lies opposite corner i of the master.
  std::optional<fem::Part<dim - 1>> part{};
  /// w n on the slave, -w dM/dS n on the master, n the outward normal of the facet: {sigma} is the sum of
  /// sigma * stress_direction over the sides.
  Point<dim> stress_direction = Point<dim>::Zero();
  double sign = 1;  ///< of v in [v] = v^s - v^m

  /// The point of the reference facet with coordinates s on the segment.
  [[nodiscard]] Point<dim - 1> on_facet(const Point<dim - 1>& s) const
  {
    return part ? fem::point_in<dim - 1>(*part, s) : s;
  }
};

/// A part of the contact boundary. With [v] = v^s - v^m o Pi, Pi the affine map onto the master, and N the
/// direction of contact,
///     P(v) = {sigma(v)} - gamma ([v] - g N);
/// against a rigid obstacle [v] = v and {sigma} = sigma n.
template <int dim>
struct ContactSegment
{
  SegmentSide<dim> slave;
  std::optional<SegmentSide<dim>> master{};  ///< absent: a rigid obstacle
  /// N if it is constant on the segment: the slave's outward normal, or the direction that the contact gives.
  /// Any unit vector will do: P^n = P.N and P^t are the parts of P in an orthonormal frame.
  Point<dim> normal;
  const problem::NormalField* varying_normal = nullptr;  ///< N if it varies; otherwise null
  double measure;                                        ///< of the part of the slave facet
  double h;                                              ///< the smaller diameter of the facets
  double gamma;  ///< gamma_0 c, c the harmonic sum of modulus / diameter of the sides
  const problem::Contact* contact;
  int pair = -1;                       ///< number in Problem::pairs(); -1: an obstacle
  std::array<Point<dim>, dim> offset;  ///< Pi(x) - x at the corners; 0 against an obstacle

  /// N at a point of the slave.
  [[nodiscard]] Point<dim> normal_at(const Point<dim>& x) const
  {
    return varying_normal == nullptr ? normal : (*varying_normal)(x);
  }
  /// g at the point x with coordinates s on the segment, where N is n.
  [[nodiscard]] double gap(const Point<dim - 1>& s, const Point<dim>& x, const Point<dim>& n) const
  {
    if (contact->gap) return (*contact->gap)(x);
    const double first = n.dot(offset[0]);
    double sum = first;
    for (int i = 1; i < dim; ++i) sum += s[i - 1] * (n.dot(offset[i]) - first);
    return sum;
  }
  /// The same at many points: n[q] is N and g[q] the gap at x[q], which has the coordinates s[q].
  void directions_and_gaps(std::span<const Point<dim - 1>> s, std::span<const Point<dim>> x,
                           std::span<Point<dim>> n, std::span<double> g) const;

  /// |segment| / |reference facet|.
  [[nodiscard]] double det() const { return mesh::factorial<dim - 1> * measure; }
  /// Calls visit(side) for the slave, and for the master if there is one.
  template <typename Visit>
  void for_each_side(const Visit& visit) const
  {
    visit(slave);
    if (master) visit(*master);
  }
  /// Whether it is a whole facet against a rigid obstacle.
  [[nodiscard]] bool is_obstacle_facet() const { return !master && !slave.part; }
};

/// The facets of a segment if it is the whole of both up to rounding: they match.
template <int dim>
[[nodiscard]] std::optional<mesh::TwinFacets<dim>> matching_facets(const mesh::Mesh<dim>& mesh,
                                                                   const ContactSegment<dim>& segment);
/// The matching facets of all segments.
template <int dim>
[[nodiscard]] std::vector<mesh::TwinFacets<dim>> twin_facets(const mesh::Mesh<dim>& mesh,
                                                             std::span<const ContactSegment<dim>> segments);

/// The points of a segment on one of its sides, by their coordinates on the segment.
template <int dim>
[[nodiscard]] SimplexMap<dim - 1, dim> simplex_map(const mesh::Mesh<dim>& mesh, const SegmentSide<dim>& side);

/// N at the centre of the slave.
template <int dim>
[[nodiscard]] Point<dim> normal_at_centre(const mesh::Mesh<dim>& mesh, const ContactSegment<dim>& segment)
{
  return segment.normal_at(simplex_map(mesh, segment.slave)(Point<dim - 1>::Constant(1.0 / dim)));
}

/// On several ranks: whether the slave is a facet of an own cell.
template <int dim>
[[nodiscard]] bool is_owned(const mesh::Mesh<dim>& mesh, const ContactSegment<dim>& segment)
{
  return segment.slave.facet.cell < mesh.n_owned_cells();
}

/// The segment between parts of the slave and of the master, or an obstacle. It keeps a pointer to `contact`.
/// The sides are weighted by their stiffness, with M = the penalty modulus of a side, J = dM/dS:
///     c_s = M_s/h_s,  c_m = J M_m/h_m,  w_s = c_m/(c_s + c_m),  w_m = c_s/(c_s + c_m),
///     gamma = gamma_0 c_s c_m/(c_s + c_m);  against an obstacle w_s = 1, gamma = gamma_0 c_s.
template <int dim>
[[nodiscard]] ContactSegment<dim> make_segment(const problem::Problem<dim>& problem,
                                               const mesh::Mesh<dim>& mesh, double gamma0,
                                               const problem::Contact& contact, const FacetPart<dim>& slave,
                                               const std::optional<FacetPart<dim>>& master = {});

/// All of Gamma_C: the facets against rigid obstacles, each a segment, then the overlays of the pairs. On a
/// distributed mesh, after with_partners(), owned segments come first; all ranks call it together. Throws
/// InputError as overlay() does, and if no part of a slave is covered.
template <int dim>
[[nodiscard]] std::vector<ContactSegment<dim>> contact_segments(const problem::Problem<dim>& problem,
                                                                const mesh::Mesh<dim>& mesh, double gamma0);

}  // namespace tribound::contact
