#include "tribound/certify/energy/quantity_parts.h"

#include <fmt/format.h>

#include <array>

#include "tribound/contact/nitsche/given_data.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

namespace
{

using problem::QuantityKind;

/// The measure and the mean outward normal of a boundary, on a meridian with the weight r; 0 if there is
/// none.
template <int dim>
void set_geometry(const contact::NitscheForm<dim>& form, QuantityParts<dim>& parts)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  Point<dim + 1> sum = Point<dim + 1>::Zero();  // the last entry: the measure
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const bool counts =
        parts.tag >= 0 ? facet.tag == parts.tag : form.problem().contact(facet.tag) != nullptr;
    if (!counts) continue;
    const double measure = contact::weighted_measure(form.problem(), mesh, facet);
    sum.template head<dim>() += measure * mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
    sum[dim] += measure;
  }
  mesh.ranks().sum(std::span(sum.data(), sum.size()));
  parts.measure = sum[dim];
  constexpr double rounding = 1e-12;
  Point<dim> mean = sum.template head<dim>();
  if (!(mean.norm() > rounding * sum[dim])) return;
  mean.normalize();
  for (double& component : mean)
    if (std::abs(component) <= rounding) component = 0;
  parts.direction = mean;
}

/// Whether all facets of the boundary have the outward normal n. All ranks together.
template <int dim>
bool is_plane(const mesh::Mesh<dim>& mesh, int tag, const Point<dim>& n)
{
  constexpr double rounding = 1e-10;
  const auto differs = [&](const mesh::BoundaryFacet& facet)
  {
    return facet.tag == tag &&
           (mesh::facet_geometry(mesh, facet.cell, facet.local).normal - n).norm() > rounding;
  };
  return !mesh.ranks().any(std::ranges::any_of(mesh.owned_boundary(), differs));
}

/// Orthonormal vectors orthogonal to n.
template <int dim>
std::array<Point<dim>, dim - 1> tangents(const Point<dim>& n)
{
  if constexpr (dim == 2)
    return {Point<2>(-n[1], n[0])};
  else
  {
    Eigen::Index least = 0;
    n.cwiseAbs().minCoeff(&least);
    const Point<3> first = mesh::cross(n, Point<3>::Unit(least)).normalized();
    return {first, mesh::cross(n, first)};
  }
}

/// The integral of p_w over a boundary, on a meridian with the weight r.
template <int dim>
KnownNumber uplift_on(const contact::NitscheForm<dim>& form, int tag)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::array<double, 2> sums{};  // U, what quadrature may miss
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    if (segment.slave.facet.tag != tag || !segment.contact->water) continue;
    for (const contact::ContactPoint<dim>& point : form.contact_points(k))
      sums[0] += point.weight * point.water;
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const double most = problem::largest_weight<dim>(
        form.problem(),
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local)));
    for (const contact::ContactDatumPart<dim>& part : form.data().contact_parts(k))
      sums[1] += 2 * part.water * most * segment.measure * fem::fraction<dim - 1>(part.part);
  }
  mesh.ranks().sum(std::span(sums));
  constexpr double rounding = 1e-14;
  return {sums[0], sums[1] + rounding * sums[0]};
}

template <int dim>
void set_safety_parts(const contact::NitscheForm<dim>& form, QuantityParts<dim>& parts)
{
  parts.coefficient = problem::cone(form.problem().contact(parts.tag)->law).coefficient;
  parts.uplift = uplift_on(form, parts.tag);
  if (const auto& water = form.problem().contact(parts.tag)->water; water && water->follows_crack())
    parts.note = "with water as far as the computed crack";
  const Point<dim> n = parts.direction;
  if (!is_plane<dim>(form.space().mesh(), parts.tag, n))
  {
    parts.reason = "the boundary is not plane";
    return;
  }
  if (form.problem().is_axisymmetric() && n[1] != 0)
  {
    parts.reason = "a body of revolution slides on cylinders alone";
    return;
  }
  parts.resultants.push_back({.tag = parts.tag, .motion = {.translation = -n}});
  for (const Point<dim>& t : tangents<dim>(n))
    parts.resultants.push_back({.tag = parts.tag, .motion = {.translation = t}});
}

}  // namespace

template <int dim>
QuantityParts<dim> parts_of(const contact::NitscheForm<dim>& form, const problem::Quantity<dim>& quantity)
{
  QuantityParts<dim> parts{
      .quantity = quantity,
      .tag = problem::boundary_number(quantity, form.problem(), form.space().mesh().boundary_names()),
      .resultants = {}};
  if (quantity.direction && !(quantity.direction->norm() > 0))
    throw InputError(quantity.where, "the direction is 0", "a vector of any other length");
  if (quantity.kind == QuantityKind::energy || quantity.kind == QuantityKind::load_work) return parts;
  set_geometry(form, parts);
  if (quantity.kind == QuantityKind::safety_factor)
  {
    set_safety_parts(form, parts);
    return parts;
  }
  if (quantity.kind == QuantityKind::mean_displacement && parts.measure == 0)
    parts.reason = "the boundary is the axis";
  if (quantity.direction) parts.direction = quantity.direction->normalized();
  const bool needs_direction = dim == 3 || quantity.kind != QuantityKind::contact_moment;
  if (needs_direction && parts.direction.isZero())
    parts.reason = "the boundary has no mean normal: give a direction";
  if (quantity.kind == QuantityKind::contact_force)
    parts.resultants.push_back({.tag = parts.tag, .motion = {.translation = parts.direction}});
  if (quantity.kind == QuantityKind::contact_moment)
    parts.resultants.push_back(
        {.tag = parts.tag,
         .motion = rotation<dim>(quantity.point.value_or(Point<dim>::Zero()), parts.direction)});
  return parts;
}

template <int dim>
double mean_displacement(const contact::NitscheForm<dim>& form, const QuantityParts<dim>& parts,
                         std::span<const double> u)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  std::array<std::optional<fem::Tabulation<dim>>, dim + 1> tables;
  double sum = 0;
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    if (facet.tag != parts.tag) continue;
    std::optional<fem::Tabulation<dim>>& table = tables[facet.local];
    if (!table) table = space.basis().tabulate(fem::points_on_facet<dim>(facet.local, rule.points));
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
      sum += form.problem().weight(x) * dx *
             parts.direction.dot(fem::value_at<dim>(space.cell_nodes(facet.cell), u, table->values_at(q)));
  }
  return mesh.ranks().sum(sum) / parts.measure;
}

template <int dim>
double contact_work(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t,
                    std::span<const Point<dim>> phi)
{
  double sum = 0;
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
    sum += form.contact_points()[i].weight * t[i].dot(phi[i]);
  return form.space().mesh().ranks().sum(sum);
}

template QuantityParts<2> parts_of(const contact::NitscheForm<2>&, const problem::Quantity<2>&);
template QuantityParts<3> parts_of(const contact::NitscheForm<3>&, const problem::Quantity<3>&);
template double mean_displacement(const contact::NitscheForm<2>&, const QuantityParts<2>&,
                                  std::span<const double>);
template double mean_displacement(const contact::NitscheForm<3>&, const QuantityParts<3>&,
                                  std::span<const double>);
template double contact_work(const contact::NitscheForm<2>&, std::span<const Point<2>>,
                             std::span<const Point<2>>);
template double contact_work(const contact::NitscheForm<3>&, std::span<const Point<3>>,
                             std::span<const Point<3>>);

}  // namespace tribound::certify
