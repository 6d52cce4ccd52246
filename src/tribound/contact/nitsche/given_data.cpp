#include "tribound/contact/nitsche/given_data.h"

#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

namespace tribound::contact
{

template <int dim>
Datum<dim> body_datum(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, Index cell)
{
  Datum<dim> datum;
  const auto& f = problem.body_force(mesh.region(cell));
  for (int i = 0; i < dim; ++i)
    if (!f[i].is_zero()) datum.terms.push_back({&f[i], Point<dim>::Unit(i)});
  return datum;
}

template <int dim>
Datum<dim> traction_datum(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                          const mesh::BoundaryFacet& facet)
{
  const problem::BoundaryCondition<dim>& boundary = problem.boundary(facet.tag);
  Datum<dim> datum;
  Point<dim> against_normal = -mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
  for (int i = 0; i < dim; ++i)
  {
    if (boundary.clamps(i))
      against_normal[i] = 0;
    else if (!boundary.traction[i].is_zero())
      datum.terms.push_back({&boundary.traction[i], Point<dim>::Unit(i)});
  }
  if (boundary.pressure && !boundary.pressure->is_zero())
    datum.terms.push_back({&*boundary.pressure, against_normal});
  return datum;
}

template <int dim>
Datum<dim, 3> contact_datum(const ContactSegment<dim>& segment)
{
  Datum<dim, 3> datum;
  const problem::Contact& contact = *segment.contact;
  if (contact.gap) datum.terms.push_back({&*contact.gap, segment.gamma * Point<3>::Unit(0)});
  if (const problem::Field* strength = cone(contact.law).strength)
    datum.terms.push_back({strength, Point<3>::Unit(1)});
  if (contact.water) datum.terms.push_back({&contact.water->pressure(), Point<3>::Unit(2)});
  return datum;
}

template <int dim>
double weighted_measure(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                        const mesh::BoundaryFacet& facet)
{
  const auto vertices =
      mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
  return problem::mean_weight<dim>(problem, vertices) *
         mesh::facet_geometry<dim>(vertices, facet.local).measure;
}

template Datum<2> body_datum(const problem::Problem<2>&, const mesh::Mesh<2>&, Index);
template Datum<3> body_datum(const problem::Problem<3>&, const mesh::Mesh<3>&, Index);
template Datum<2> traction_datum(const problem::Problem<2>&, const mesh::Mesh<2>&,
                                 const mesh::BoundaryFacet&);
template Datum<3> traction_datum(const problem::Problem<3>&, const mesh::Mesh<3>&,
                                 const mesh::BoundaryFacet&);
template double weighted_measure(const problem::Problem<2>&, const mesh::Mesh<2>&,
                                 const mesh::BoundaryFacet&);
template double weighted_measure(const problem::Problem<3>&, const mesh::Mesh<3>&,
                                 const mesh::BoundaryFacet&);
template Datum<2, 3> contact_datum(const ContactSegment<2>&);
template Datum<3, 3> contact_datum(const ContactSegment<3>&);

}  // namespace tribound::contact
