#include "tribound/contact/nitsche/segment.h"

#include <algorithm>
#include <cassert>

#include "tribound/contact/nitsche/penalty.h"

namespace tribound::contact
{

namespace
{

/// A side with what weights are made from.
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

}  // namespace

template <int dim>
ContactSegment<dim> make_segment(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                 double gamma0, const FacetPart<dim>& slave,
                                 const std::optional<FacetPart<dim>>& master)
{
  WeighedSide<dim> s = weigh(problem, mesh, slave, 1);
  const auto& contact = problem.boundary(s.side.facet.tag).contact;
  assert(contact);
  ContactSegment<dim> segment{.slave = {},
                              .normal = s.geometry.normal,
                              .measure = s.measure,
                              .h = s.geometry.diameter,
                              .gamma = gamma0 * s.stiffness,
                              .contact = &*contact};
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
    segment.master = std::move(m.side);
  }
  segment.slave = std::move(s.side);
  return segment;
}

template <int dim>
std::vector<ContactSegment<dim>> obstacle_segments(const problem::Problem<dim>& problem,
                                                   const mesh::Mesh<dim>& mesh, double gamma0)
{
  std::vector<ContactSegment<dim>> segments;
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
    if (problem.boundary(mesh.boundary()[number].tag).contact)
      segments.push_back(make_segment<dim>(problem, mesh, gamma0, {number}));
  return segments;
}

template ContactSegment<2> make_segment(const problem::Problem<2>&, const mesh::Mesh<2>&, double,
                                        const FacetPart<2>&, const std::optional<FacetPart<2>>&);
template ContactSegment<3> make_segment(const problem::Problem<3>&, const mesh::Mesh<3>&, double,
                                        const FacetPart<3>&, const std::optional<FacetPart<3>>&);
template std::vector<ContactSegment<2>> obstacle_segments(const problem::Problem<2>&, const mesh::Mesh<2>&,
                                                          double);
template std::vector<ContactSegment<3>> obstacle_segments(const problem::Problem<3>&, const mesh::Mesh<3>&,
                                                          double);

}  // namespace tribound::contact
