#include "tribound/contact/nitsche/segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tribound/base/error.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/mesh/describe.h"

namespace tribound::contact
{

namespace
{

/// A side with the data for its weight.
template <int dim>
struct WeighedSide
{
  SegmentSide<dim> side;
  mesh::FacetGeometry<dim> geometry;
  double measure;    ///< of the part
  double stiffness;  ///< modulus / diameter
};

template <int dim>
WeighedSide<dim> weigh(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                       const FacetPart<dim>& which, double sign)
{
  const mesh::BoundaryFacet& facet = mesh.boundary()[which.number];
  const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
  const double share = which.part ? fem::fraction<dim - 1>(*which.part) : 1;
  return {{.facet = facet, .number = which.number, .part = which.part, .sign = sign},
          geometry,
          share * geometry.measure,
          penalty_modulus(problem.material(mesh.region(facet.cell))) / geometry.diameter};
}

/// Pi(x) - x at the corners.
template <int dim>
std::array<Point<dim>, dim> offsets(const mesh::Mesh<dim>& mesh, const WeighedSide<dim>& slave,
                                    const WeighedSide<dim>& master)
{
  const SimplexMap<dim - 1, dim> on_slave = simplex_map(mesh, slave.side);
  const SimplexMap<dim - 1, dim> on_master = simplex_map(mesh, master.side);
  std::array<Point<dim>, dim> result;
  const auto corners = fem::reference_simplex<dim - 1>();
  for (int i = 0; i < dim; ++i) result[i] = on_master(corners[i]) - on_slave(corners[i]);
  return result;
}

}  // namespace

template <int dim>
void ContactSegment<dim>::directions_and_gaps(std::span<const Point<dim - 1>> s,
                                              std::span<const Point<dim>> x, std::span<Point<dim>> n,
                                              std::span<double> g) const
{
  if (varying_normal != nullptr)
    varying_normal->evaluate<dim>(x, n);
  else
    std::ranges::fill(n, normal);
  if (contact->gap)
    contact->gap->template evaluate<dim>(x, g);
  else
    for (std::size_t q = 0; q < g.size(); ++q) g[q] = gap(s[q], x[q], n[q]);
}

namespace
{

/// Coordinates on reference facets that differ by less are the same. Corners of facets that nearly match are
/// exact: the pairing has moved them.
constexpr double same_corner = 1e-9;

/// The vertices of the facet of a side in the order of the side's corners; absent if a corner is not a
/// vertex.
template <int dim>
std::optional<std::array<Index, dim>> vertices_at_corners(const mesh::Mesh<dim>& mesh,
                                                          const SegmentSide<dim>& side)
{
  const fem::Part<dim - 1> corners = fem::reference_simplex<dim - 1>();
  const std::array<Index, dim> of_facet = mesh::facet_vertices(mesh.cell(side.facet.cell), side.facet.local);
  std::array<Index, dim> result{};
  for (int i = 0; i < dim; ++i)
  {
    const Point<dim - 1> x = side.on_facet(corners[i]);
    const auto found = std::ranges::find_if(
        corners, [&](const Point<dim - 1>& y) { return (x - y).cwiseAbs().maxCoeff() <= same_corner; });
    if (found == corners.end()) return std::nullopt;
    result[i] = of_facet[found - corners.begin()];
  }
  return result;
}

}  // namespace

template <int dim>
std::optional<mesh::TwinFacets<dim>> matching_facets(const mesh::Mesh<dim>& mesh,
                                                     const ContactSegment<dim>& segment)
{
  if (!segment.master) return std::nullopt;
  const auto slave = vertices_at_corners(mesh, segment.slave);
  const auto master = vertices_at_corners(mesh, *segment.master);
  if (!slave || !master) return std::nullopt;
  return mesh::TwinFacets<dim>{{segment.slave.facet.cell, segment.master->facet.cell}, {*slave, *master}};
}

template <int dim>
std::vector<mesh::TwinFacets<dim>> twin_facets(const mesh::Mesh<dim>& mesh,
                                               std::span<const ContactSegment<dim>> segments)
{
  std::vector<mesh::TwinFacets<dim>> result;
  for (const ContactSegment<dim>& segment : segments)
    if (const auto twins = matching_facets(mesh, segment)) result.push_back(*twins);
  return result;
}

template <int dim>
SimplexMap<dim - 1, dim> simplex_map(const mesh::Mesh<dim>& mesh, const SegmentSide<dim>& side)
{
  SimplexMap<dim - 1, dim> map = simplex_map(mesh, side.facet);
  if (!side.part) return map;
  const fem::Part<dim - 1>& part = *side.part;
  Eigen::Matrix<double, dim - 1, dim - 1> edges;
  for (int i = 1; i < dim; ++i) edges.col(i - 1) = part[i] - part[0];
  return {map(part[0]), map.jacobian * edges, fem::fraction<dim - 1>(part) * map.measure};
}

template <int dim>
ContactSegment<dim> make_segment(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                 double gamma0, const problem::Contact& contact, const FacetPart<dim>& slave,
                                 const std::optional<FacetPart<dim>>& master)
{
  WeighedSide<dim> s = weigh(problem, mesh, slave, 1);
  ContactSegment<dim> segment{.slave = {},
                              .normal = s.geometry.normal,
                              .measure = s.measure,
                              .h = s.geometry.diameter,
                              .gamma = gamma0 * s.stiffness,
                              .contact = &contact,
                              .offset = {}};
  segment.offset.fill(Point<dim>::Zero());
  if (contact.normal && contact.normal->is_constant())
    segment.normal = (*contact.normal)(Point<dim>(Point<dim>::Zero()));
  else if (contact.normal)
    segment.varying_normal = &*contact.normal;
  s.side.stress_direction = s.geometry.normal;
  if (master)
  {
    WeighedSide<dim> m = weigh(problem, mesh, *master, -1);
    const double stretch = m.measure / s.measure;  // dM/dS
    const double c_m = stretch * m.stiffness;
    const double sum = s.stiffness + c_m;
    s.side.stress_direction *= c_m / sum;
    m.side.stress_direction = -(s.stiffness / sum * stretch) * m.geometry.normal;
    segment.gamma = gamma0 * s.stiffness * c_m / sum;
    segment.h = std::min(segment.h, m.geometry.diameter);
    segment.offset = offsets(mesh, s, m);
    segment.master = std::move(m.side);
  }
  segment.slave = std::move(s.side);
  return segment;
}

namespace
{

/// On a meridian both sides have the same weight r: they lie opposite each other at the same radius.
template <int dim>
void require_same_radius(const mesh::Mesh<dim>& mesh, const ContactSegment<dim>& segment, const Where& where)
{
  constexpr double rounding = 1e-9;
  const bool fits = std::ranges::all_of(
      segment.offset, [&](const Point<dim>& offset) { return std::abs(offset[0]) <= rounding * segment.h; });
  if (fits) return;
  const Point<dim> centre = simplex_map(mesh, segment.slave)(Point<dim - 1>::Constant(1.0 / dim));
  throw InputError(where,
                   fmt::format("the facets of the two bodies of revolution near {} do not lie opposite each "
                               "other at the same radius",
                               mesh::describe(centre)),
                   "bodies that touch at the same radius; play or interference as gap = -0.01");
}

}  // namespace

template <int dim>
std::vector<ContactSegment<dim>> contact_segments(const problem::Problem<dim>& problem,
                                                  const mesh::Mesh<dim>& mesh, double gamma0)
{
  std::vector<ContactSegment<dim>> segments;
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
    if (const auto& contact = problem.boundary(mesh.boundary()[number].tag).contact)
      segments.push_back(make_segment<dim>(problem, mesh, gamma0, *contact, {number}));
  for (std::size_t k = 0; k < problem.pairs().size(); ++k)
  {
    const problem::ContactPair<dim>& pair = problem.pairs()[k];
    if (mesh.ranks().size() > 1 && !mesh.has_partners())
      throw InputError(pair.where, "the mesh of this process lacks what lies opposite to it",
                       "a mesh from contact::with_partners(), as adapt::Discretisation makes it");
    const std::vector<FacetPair<dim>> parts = mesh.ranks().together(
        [&]
        {
          return overlay<dim>(mesh, mesh::facets_named(mesh, pair.slave),
                              mesh::facets_named(mesh, pair.master), pair.pairing, pair.where);
        });
    if (!mesh.ranks().any(!parts.empty()))
      throw InputError(pair.where, "nothing of the master lies opposite the slave",
                       "the outward normals of slave and master must face each other, within reach");
    mesh.ranks().together(
        [&]
        {
          for (const auto& [slave, master] : parts)
          {
            segments.push_back(make_segment<dim>(problem, mesh, gamma0, pair.contact, slave, master));
            segments.back().pair = static_cast<int>(k);
            if (problem.is_axisymmetric()) require_same_radius(mesh, segments.back(), pair.where);
          }
        });
  }
  std::stable_partition(segments.begin(), segments.end(),
                        [&](const ContactSegment<dim>& segment) { return is_owned(mesh, segment); });
  return segments;
}

template struct ContactSegment<2>;
template struct ContactSegment<3>;
template std::optional<mesh::TwinFacets<2>> matching_facets(const mesh::Mesh<2>&, const ContactSegment<2>&);
template std::optional<mesh::TwinFacets<3>> matching_facets(const mesh::Mesh<3>&, const ContactSegment<3>&);
template std::vector<mesh::TwinFacets<2>> twin_facets(const mesh::Mesh<2>&,
                                                      std::span<const ContactSegment<2>>);
template std::vector<mesh::TwinFacets<3>> twin_facets(const mesh::Mesh<3>&,
                                                      std::span<const ContactSegment<3>>);
template SimplexMap<1, 2> simplex_map(const mesh::Mesh<2>&, const SegmentSide<2>&);
template SimplexMap<2, 3> simplex_map(const mesh::Mesh<3>&, const SegmentSide<3>&);
template ContactSegment<2> make_segment(const problem::Problem<2>&, const mesh::Mesh<2>&, double,
                                        const problem::Contact&, const FacetPart<2>&,
                                        const std::optional<FacetPart<2>>&);
template ContactSegment<3> make_segment(const problem::Problem<3>&, const mesh::Mesh<3>&, double,
                                        const problem::Contact&, const FacetPart<3>&,
                                        const std::optional<FacetPart<3>>&);
template std::vector<ContactSegment<2>> contact_segments(const problem::Problem<2>&, const mesh::Mesh<2>&,
                                                         double);
template std::vector<ContactSegment<3>> contact_segments(const problem::Problem<3>&, const mesh::Mesh<3>&,
                                                         double);

}  // namespace tribound::contact
