#include "tribound/adapt/path_measure.h"

#include <fmt/format.h>

#include "tribound/contact/nitsche/crack_mouth.h"
#include "tribound/fem/evaluation.h"

namespace tribound::adapt
{

namespace
{

/// c_i += factor / |Gamma| times the integral of phi_i over the boundary.
template <int dim>
void add_mean(const contact::NitscheForm<dim>& form, int tag, const Point<dim>& factor, std::span<double> c)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  const fem::Quadrature<dim - 1> rule =
      fem::quadrature<dim - 1>(space.degree() + (form.problem().is_axisymmetric() ? 1 : 0));
  const fem::FacetTabulation<dim> table = fem::tabulate_on_facets<dim>(space.basis(), rule.points);
  std::vector<double> integrals(c.size(), 0.0);
  double area = 0;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag != tag) continue;
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
    {
      const double weight = dx * form.problem().weight(x);
      fem::add_at_point<dim>(space.cell_nodes(facet.cell), table.on_facet[facet.local].values_at(q),
                             weight * factor, integrals);
      if (facet.cell < mesh.n_owned_cells()) area += weight;
    }
  }
  area = mesh.ranks().sum(area);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] += integrals[i] / area;
}

/// c_i += factor / |Gamma| times the integral of -[phi_i]^n over the contact boundary.
template <int dim>
void add_mean_opening(const contact::NitscheForm<dim>& form, int tag, double factor, std::span<double> c)
{
  std::vector<Point<dim>> t(form.n_contact_points(), Point<dim>::Zero());
  double area = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
  {
    if (form.segments()[i / form.n_segment_points()].slave.facet.tag != tag) continue;
    t[i] = -factor * form.contact_points()[i].normal;
    if (i < form.n_owned_contact_points()) area += form.contact_points()[i].weight;
  }
  area = form.space().mesh().ranks().sum(area);
  for (Point<dim>& value : t) value /= area > 0 ? area : 1.0;
  form.add_contact_load(t, c);
}

/// c_i += factor times the opening -[phi_i]^n or the sliding [phi_i]^t at the mouth of the crack.
template <int dim>
void add_at_mouth(const contact::NitscheForm<dim>& form, int tag, Jump jump, double factor,
                  std::span<double> c)
{
  const contact::CrackMouth mouth = contact::crack_mouth(form, tag);
  const Point<dim> e(form.problem().contact(tag)->base->direction().data());
  std::vector<Point<dim>> t(form.n_contact_points(), Point<dim>::Zero());
  for (const std::size_t i : mouth.points)
  {
    const contact::ContactPoint<dim>& point = form.contact_points()[i];
    const Point<dim> along = e - e.dot(point.normal) * point.normal;
    t[i] =
        factor / (mouth.n * point.weight) * (jump == Jump::mouth_opening ? Point<dim>(-point.normal) : along);
  }
  form.add_contact_load(t, c);
}

/// The integral of value(i) at contact points i over all bonded interfaces, on the full circle.
template <int dim, class Value>
double sum_over_bonds(const contact::NitscheForm<dim>& form, const Value& value)
{
  double sum = 0;
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
    if (problem::cone(form.segments()[i / form.n_segment_points()].contact->law).is_bonded)
      sum += form.contact_points()[i].weight * value(i);
  return form.problem().full_circle() * form.space().mesh().ranks().sum(sum);
}

}  // namespace

template <int dim>
int gauged_boundary(const problem::Problem<dim>& problem, const Gauge& gauge)
{
  std::vector<std::string> names;
  for (const problem::BoundaryCondition<dim>& boundary : problem.boundaries()) names.push_back(boundary.name);
  const int tag = problem::group_number(gauge.boundary, names, gauge.where, "boundary");
  if (gauge.component.value_or(0) >= dim)
    throw InputError(gauge.where, "has a z component, but the case is 2D",
                     "one of " + gauge.boundary + ".x, .y");
  if (!gauge.component && problem.contact(tag) == nullptr)
    throw InputError(gauge.where,
                     fmt::format("\"{}\" is not on a contact boundary, so it has no opening", gauge.boundary),
                     "a boundary with contact, or a component: " + gauge.boundary + ".x");
  if (!gauge.component && gauge.jump != Jump::opening && !problem.contact(tag)->base)
    throw InputError(gauge.where, fmt::format("the interface of \"{}\" has no heel", gauge.boundary),
                     "heel = [0, 0] and toe = [60, 0] in its table, or " + gauge.boundary + ".opening");
  return tag;
}

template <int dim>
std::vector<double> functional(const contact::NitscheForm<dim>& form, std::span<const Gauge> gauges)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  std::vector<double> c(space.n_dofs(), 0.0);
  for (const Gauge& gauge : gauges)
  {
    const int tag = gauged_boundary(form.problem(), gauge);
    if (gauge.component)
      add_mean<dim>(form, tag, gauge.factor * Point<dim>::Unit(*gauge.component), c);
    else if (gauge.jump == Jump::opening)
      add_mean_opening(form, tag, gauge.factor, c);
    else
      add_at_mouth(form, tag, gauge.jump, gauge.factor, c);
  }
  return c;
}

template <int dim>
double bonded_measure(const contact::NitscheForm<dim>& form)
{
  return sum_over_bonds(form, [](std::size_t) { return 1.0; });
}

template <int dim>
double PathMeasure<dim>::value(const contact::NitscheForm<dim>& form, std::span<const double> u) const
{
  if (functional_) return form.space().dot(*functional_, u);
  const std::vector<problem::InterfaceResponse<dim>> responses = form.advance(u);
  return sum_over_bonds(form, [&](std::size_t i) { return responses[i].state.damage; });
}

template <int dim>
std::array<double, 2> PathMeasure<dim>::derivatives(const contact::NitscheForm<dim>& form,
                                                    std::span<const double> u,
                                                    const std::array<std::span<const double>, 2>& d) const
{
  if (functional_) return {form.space().dot(*functional_, d[0]), form.space().dot(*functional_, d[1])};
  const std::vector<problem::InterfaceResponse<dim>> responses = form.advance(u);
  const std::size_t n = form.n_segment_points();
  std::array<double, 2> sums{};
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    if (!problem::cone(form.segments()[k].contact->law).is_bonded) continue;
    for (std::size_t j = 0; j < d.size(); ++j)
    {
      const auto change = form.traction_without_gap(d[j], k);
      for (std::size_t q = 0; q < n; ++q)
        sums[j] += form.contact_points(k)[q].weight *
                   responses[k * n + q].damage_gradient.dot(change.col(static_cast<Eigen::Index>(q)));
    }
  }
  form.space().mesh().ranks().sum(std::span(sums));
  for (double& value : sums) value *= form.problem().full_circle();
  return sums;
}

template int gauged_boundary(const problem::Problem<2>&, const Gauge&);
template int gauged_boundary(const problem::Problem<3>&, const Gauge&);
template std::vector<double> functional(const contact::NitscheForm<2>&, std::span<const Gauge>);
template std::vector<double> functional(const contact::NitscheForm<3>&, std::span<const Gauge>);
template double bonded_measure(const contact::NitscheForm<2>&);
template double bonded_measure(const contact::NitscheForm<3>&);
template class PathMeasure<2>;
template class PathMeasure<3>;

}  // namespace tribound::adapt
