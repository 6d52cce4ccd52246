#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/certify/bound/certificate.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

template <int dim>
double dirichlet_interpolation_error(const contact::NitscheForm<dim>& form)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const fem::FacetTabulation<dim> table =
      fem::tabulate_on_facets<dim>(space.basis(), form.facet_rule().points);
  double largest = 0;
  for (const mesh::BoundaryFacet& facet : space.mesh().owned_boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    if (!boundary.clamps_any()) continue;
    for (const auto& [q, x, dx] : fem::facet_points(space.mesh(), facet.cell, facet.local, form.facet_rule()))
    {
      const Point<dim> interpolant = fem::value_at<dim>(
          space.cell_nodes(facet.cell), form.constraints().values, table.on_facet[facet.local].values_at(q));
      for (int c = 0; c < dim; ++c)
        if (boundary.clamps(c))
          largest = std::max(largest, std::abs((*boundary.displacement[c])(x)-interpolant[c]));
    }
  }
  return space.mesh().ranks().max(largest);
}

namespace
{

/// How far the value at a node of a facet may be from those of the formula around the node: more than
/// rounding if the formula jumps there.
template <int dim>
double jump_at_nodes(const contact::NitscheForm<dim>& form, const mesh::BoundaryFacet& facet, int component)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const problem::Field& u_D = *form.problem().boundary(facet.tag).displacement[component];
  const mesh::FacetMap<dim> map = mesh::facet_map(space.mesh(), facet.cell, facet.local);
  double largest = 0;
  for (int i = 0; i < space.basis().n_nodes(); ++i)
  {
    if (space.basis().node(i)[facet.local] > 0) continue;
    const Point<dim> x = map(mesh::cell_to_facet<dim>(facet.local, space.basis().node_point(i)));
    const double value = form.constraints().values[dim * space.cell_nodes(facet.cell)[i] + component];
    std::array<problem::Enclosure, 1> near;
    u_D.enclose({x.data(), dim}, dim, near, problem::Sides::around);
    largest = std::max({largest, near[0].upper - value, value - near[0].lower});
  }
  return largest;
}

/// Let |u_D - P| <= delta inside the facet and |v - P| <= delta' for the values v at the nodes, P of degree
/// p. Then the interpolant differs from u_D by at most delta + Lambda delta'. If delta holds on the closed
/// facet, delta' = delta; otherwise delta' exceeds delta by the difference of v from the values inside.
template <int dim>
double interpolation_bound(const contact::NitscheForm<dim>& form, const mesh::BoundaryFacet& facet,
                           int component)
{
  // For equispaced nodes on triangles, p = 1, ..., 4, rounded up; those on segments have smaller constants.
  constexpr std::array<double, 5> lebesgue = {1, 1, 1.67, 2.28, 3.48};
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const int p = form.space().degree();
  const auto points =
      mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
  const auto distance = [&](problem::Sides sides)
  {
    std::array<problem::Enclosure, 6> taylor;
    form.problem().boundary(facet.tag).displacement[component]->enclose(
        std::span(points[0].data(), dim * points.size()), dim, std::span(taylor).first(p + 2), sides);
    return problem::distance_from_polynomials(taylor, p + 1);
  };
  const double closed = distance(problem::Sides::closed);
  const double inside = distance(problem::Sides::inside);
  if (inside == closed) return (1 + lebesgue[p]) * closed;
  return std::min((1 + lebesgue[p]) * closed,
                  (1 + lebesgue[p]) * inside + lebesgue[p] * jump_at_nodes(form, facet, component));
}

}  // namespace

template <int dim>
double dirichlet_interpolation_bound(const contact::NitscheForm<dim>& form)
{
  double largest = 0;
  for (const mesh::BoundaryFacet& facet : form.space().mesh().owned_boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    for (int c = 0; c < dim; ++c)
      if (boundary.clamps(c) && boundary.displacement[c]->degree() > form.space().degree())
        largest = std::max(largest, interpolation_bound(form, facet, c));
  }
  return form.space().mesh().ranks().max(largest);
}

template double dirichlet_interpolation_bound(const contact::NitscheForm<2>&);
template double dirichlet_interpolation_bound(const contact::NitscheForm<3>&);
template double dirichlet_interpolation_error(const contact::NitscheForm<2>&);
template double dirichlet_interpolation_error(const contact::NitscheForm<3>&);

}  // namespace tribound::certify
