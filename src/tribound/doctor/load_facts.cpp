#include "tribound/doctor/load_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/contact/nitsche/given_data.h"
#include "tribound/fem/evaluation.h"

namespace tribound::doctor
{

namespace
{

template <int dim>
RegionMaterial region_material(const problem::Problem<dim>& problem, int region)
{
  const problem::Material& material = problem.material(region);
  const auto [E, nu] = elastic_constants(material, dim);
  return {problem.regions()[region].name, E, nu, dim == 2 && material.plane == problem::PlaneModel::stress};
}

template <int dim>
void measure_extent(const mesh::Mesh<dim>& mesh, LoadFacts& facts)
{
  const mesh::BoundingBox<dim> box = mesh::bounding_box(mesh.vertices());
  const Point<dim> extent = box.upper - box.lower;
  facts.extent = {extent.begin(), extent.end()};
  facts.size = box.longest_edge();
}

/// The integral of f, of bodies of revolution that for one radian; sets the largest mean of |f| over a cell.
template <int dim>
Point<dim> body_force_resultant(const contact::NitscheForm<dim>& form, LoadFacts& facts)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim>& rule = form.data().cell_rule();
  Point<dim> resultant = Point<dim>::Zero();
  std::vector<Point<dim>> f(rule.size());
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    if (!form.data().has_body_force(c)) continue;
    form.data().body_force(c, f);
    double magnitude = 0;  // mean
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, c), rule))
    {
      magnitude += mesh::factorial<dim> * rule.weights[q] * f[q].norm();
      resultant += dx * form.problem().weight(x) * f[q];
    }
    facts.largest_body_force = std::max(facts.largest_body_force, magnitude);
  }
  return resultant;
}

/// The load on a boundary.
struct BoundaryLoad
{
  double magnitude = 0;  ///< integral of |g_N|
  double measure = 0;
};

/// The integral of g_N and the forces on rigid parts, whose moments count as forces over the size, of bodies
/// of revolution those for one radian; sets the largest mean of their sizes over a boundary.
template <int dim>
Point<dim> traction_resultant(const contact::NitscheForm<dim>& form, LoadFacts& facts)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  Point<dim> resultant = Point<dim>::Zero();
  std::vector<BoundaryLoad> loads(form.problem().boundaries().size());
  std::vector<Point<dim>> g(rule.size());
  for (std::size_t k = 0; k < mesh.boundary().size(); ++k)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    if (form.problem().boundary(facet.tag).rigid)
      loads[facet.tag].measure += contact::weighted_measure(form.problem(), mesh, facet);
    if (facet.tag < 0 || !form.data().has_traction(k)) continue;
    form.data().traction(k, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
    {
      const double weight = dx * form.problem().weight(x);
      resultant += weight * g[q];
      loads[facet.tag].magnitude += weight * g[q].norm();
      loads[facet.tag].measure += weight;
    }
  }
  for (std::size_t tag = 0; tag < loads.size(); ++tag)
  {
    const auto& part = form.problem().boundary(static_cast<int>(tag)).rigid;
    if (!part) continue;
    const Point<dim> force = part->total_force() / form.problem().full_circle();
    resultant += force;
    loads[tag].magnitude = force.norm() + part->total_moment().template lpNorm<1>() / facts.size;
  }
  for (const BoundaryLoad& load : loads)
    if (load.measure > 0)
      facts.traction_stress = std::max(facts.traction_stress, load.magnitude / load.measure);
  return resultant;
}

/// Sets thermal strain and initial stress, at the points of the rule.
template <int dim>
void measure_initial_stress(const contact::NitscheForm<dim>& form, LoadFacts& facts)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const problem::Problem<dim>& problem = form.problem();
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const problem::Region<dim>& region = problem.regions()[mesh.region(c)];
    if (!region.has_initial_stress()) continue;
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, c), form.data().cell_rule()))
    {
      const double warmer =
          region.material.expansion == 0 ? 0 : region.temperature(x) - region.reference_temperature(x);
      Tensor<dim> rest = problem.initial_stress(mesh.region(c), x);
      const double thermal = thermal_modulus(region.material) * warmer;
      rest.diagonal().array() += thermal;
      const double hoop =
          problem.is_axisymmetric() ? problem.initial_stress_zz(mesh.region(c), x) + thermal : 0;
      facts.thermal_strain = std::max(facts.thermal_strain, std::abs(region.material.expansion * warmer));
      facts.initial_stress = std::max({facts.initial_stress, rest.norm(), std::abs(hoop)});
    }
  }
}

/// Boundaries with negative pressure somewhere, with the lowest value.
template <int dim>
std::vector<Suction> find_suction(const contact::NitscheForm<dim>& form)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto boundaries = form.problem().boundaries();
  std::vector<Suction> lowest(boundaries.size());
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag < 0 || !boundaries[facet.tag].pressure) continue;
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, form.facet_rule()))
      if (const double p = (*boundaries[facet.tag].pressure)(x); p < lowest[facet.tag].lowest)
        lowest[facet.tag] = {boundaries[facet.tag].name, p, place<dim>(x)};
  }
  std::erase_if(lowest, [](const Suction& suction) { return suction.lowest == 0; });
  return lowest;
}

/// The area of the boundaries that support the loads, of bodies of revolution that for one radian.
template <int dim>
double supporting_measure(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  double measure = 0;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    const problem::BoundaryCondition<dim>& condition = problem.boundary(facet.tag);
    if (problem.is_in_contact(facet.tag) || condition.holds_any())
      measure += contact::weighted_measure(problem, mesh, facet);
  }
  return measure;
}

/// The largest range of a component that is prescribed, on boundaries or where springs rest on their free
/// components. It includes 0 with contact, since obstacles are fixed, and with springs: where they rest is
/// where they pull the body to from there.
template <int dim>
double displacement_range(const contact::NitscheForm<dim>& form)
{
  const fem::Constraints& constraints = form.constraints();
  const std::span<const contact::SpringFacet<dim>> springs = form.springs().facets();
  const auto fixes = [&](const contact::SpringFacet<dim>& facet, int component)
  { return form.problem().boundary(form.space().mesh().boundary()[facet.number].tag).clamps(component); };
  const bool has_zero = form.problem().has_contact() || !springs.empty();
  const double start = has_zero ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  double range = 0;
  for (int component = 0; component < dim; ++component)
  {
    double lowest = start;
    double highest = start;
    for (std::size_t i = component; i < constraints.fixed.size(); i += dim)
    {
      if (!constraints.fixed[i]) continue;
      lowest = std::fmin(lowest, constraints.values[i]);  // fmin ignores NaN
      highest = std::fmax(highest, constraints.values[i]);
    }
    for (const contact::SpringFacet<dim>& facet : springs)
    {
      if (fixes(facet, component)) continue;
      for (const Point<dim>& rest : facet.rest.values)
      {
        lowest = std::fmin(lowest, rest[component]);
        highest = std::fmax(highest, rest[component]);
      }
    }
    range = std::fmax(range, highest - lowest);
  }
  return range;
}

/// The components of a force that no displacement condition takes up.
template <int dim>
Point<dim> left_to_springs(const problem::Problem<dim>& problem, Point<dim> force)
{
  for (const problem::BoundaryCondition<dim>& boundary : problem.boundaries())
    for (int component = 0; component < dim; ++component)
      if (boundary.clamps(component)) force[component] = 0;
  return force;
}

/// How far a force moves what the springs hold along it; 0 without springs.
template <int dim>
double shift_on(const contact::Springs<dim>& springs, const Point<dim>& force)
{
  double stiffness = 0;  // (K e, e)_S times |force|^2, e along the force
  for (const contact::SpringFacet<dim>& facet : springs.facets())
    for (std::size_t q = 0; q < facet.weights.size(); ++q)
      stiffness += facet.weights[q] * force.dot(facet.stiffness.values[q] * force);
  return stiffness > 0 ? std::pow(force.norm(), 3) / stiffness : 0;
}

}  // namespace

ElasticConstants elastic_constants(const problem::Material& material, int dimension)
{
  const auto& [lambda, mu, plane, expansion] = material;
  const bool plane_stress = dimension == 2 && plane == problem::PlaneModel::stress;
  const double nu = plane_stress ? lambda / (lambda + 2 * mu) : lambda / (2 * (lambda + mu));
  return {2 * mu * (1 + nu), nu};
}

double LoadFacts::stress() const
{
  return std::max({traction_stress, support_stress, body_stress});
}

double LoadFacts::strain() const
{
  return std::max({stress() / smallest_E, displacement_strain, interference_strain, thermal_strain,
                   initial_stress / smallest_E});
}

template <int dim>
LoadFacts load_facts(const contact::NitscheForm<dim>& form)
{
  const problem::Problem<dim>& problem = form.problem();
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  LoadFacts facts;
  measure_extent(mesh, facts);
  for (int region = 0; region < static_cast<int>(problem.regions().size()); ++region)
    facts.materials.push_back(region_material(problem, region));
  facts.smallest_E = std::ranges::min_element(facts.materials, {}, &RegionMaterial::E)->E;
  const Point<dim> resultant = body_force_resultant(form, facts) + traction_resultant(form, facts);
  const double support = supporting_measure(problem, mesh);
  if (support > 0) facts.support_stress = resultant.norm() / support;
  facts.body_stress = facts.largest_body_force * facts.size;
  facts.has_springs = problem.has_springs();
  facts.displacement_strain = displacement_range(form) / facts.size;
  if (!problem.has_contact())
    facts.spring_shift = shift_on(form.springs(), left_to_springs<dim>(problem, resultant)) / facts.size;
  for (std::size_t i = 0; i < form.n_contact_points(); ++i)
  {
    const double gap = form.contact_points()[i].gap / facts.size;
    if (cone(form.segments()[i / form.n_segment_points()].contact->law).is_bilateral)
      facts.displacement_strain = std::max(facts.displacement_strain, std::abs(gap));
    else
      facts.interference_strain = std::max(facts.interference_strain, -gap);
  }
  measure_initial_stress(form, facts);
  facts.suction = find_suction(form);
  return facts;
}

template LoadFacts load_facts(const contact::NitscheForm<2>&);
template LoadFacts load_facts(const contact::NitscheForm<3>&);

}  // namespace tribound::doctor
