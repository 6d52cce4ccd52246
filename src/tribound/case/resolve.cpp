#include "tribound/case/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "tribound/adapt/transfer.h"
#include "tribound/case/dimension.h"
#include "tribound/case/geometry_resolver.h"
#include "tribound/case/node.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/mesh/gmsh_geometry.h"

namespace tribound::case_file
{

namespace
{

template <int dim>
problem::Field in_dimension(const problem::Field& field)
{
  if (dim == 2 && field.uses_z()) throw InputError(field.where(), "uses z in a 2D case", "only x and y vary");
  return field;
}

template <int dim>
std::array<problem::Field, dim> vector_of(std::span<const problem::Field> components, const Where& where)
{
  check_length<dim>(components.size(), where);
  std::array<problem::Field, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = in_dimension<dim>(components[i]);
  return result;
}

template <int dim>
void check_dimension(const problem::Contact& contact)
{
  if (contact.gap) (void)in_dimension<dim>(*contact.gap);
  if (const problem::Field* strength = cone(contact.law).strength) (void)in_dimension<dim>(*strength);
  if (contact.water) (void)in_dimension<dim>(contact.water->pressure());
  if (contact.base) check_length<dim>(contact.base->heel.size(), contact.base->where);
}

template <int dim>
problem::ContactPair<dim> resolve(const ContactConfig& config)
{
  check_dimension<dim>(config.contact);
  problem::ContactPair<dim> pair{.slave = config.slave,
                                 .master = config.master,
                                 .contact = config.contact,
                                 .pairing = {.reach = config.reach},
                                 .where = config.where};
  if (config.direction.empty()) return pair;
  check_length<dim>(config.direction.size(), inside(config.where, "pairing"));
  pair.pairing.direction = Point<dim>(config.direction.data());
  return pair;
}

/// Refuses formulas of the place: forces and moments act on the whole part.
void require_uniform(std::span<const problem::Field> loads)
{
  for (const problem::Field& load : loads)
    if (!load.is_constant())
      throw InputError(load.where(), "depends on the place, but acts on the part as a whole",
                       "a number, or a formula of t");
}

template <int dim>
problem::RigidPart<dim> resolve(const RigidConfig& config)
{
  constexpr auto& names = problem::motion_names<dim>;
  problem::RigidPart<dim> part;
  const auto n_moments = part.moment.size();
  require_uniform(config.force);
  require_uniform(config.moment);
  if (!config.force.empty()) part.force = vector_of<dim>(config.force, inside(config.where, "force"));
  if (!config.moment.empty() && config.moment.size() != n_moments)
    throw InputError(inside(config.where, "moment"),
                     fmt::format("has {} components in a case in {}D", config.moment.size(), dim),
                     dim == 2 ? "one number, positive from x to y" : "three: about the axes x, y and z");
  std::ranges::copy(config.moment, part.moment.begin());
  for (const std::string& name : config.fixed)
  {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      throw InputError(inside(config.where, "fixed"), fmt::format("\"{}\" is no motion in 2D", name),
                       "x, y and rz");
    part.fixed[found - names.begin()] = true;
  }
  if (!config.point.empty())
  {
    check_length<dim>(config.point.size(), inside(config.where, "point"));
    part.point = Point<dim>(config.point.data());
  }
  else if (!std::ranges::all_of(std::span(part.fixed).subspan(dim), std::identity()))
    throw InputError(config.where,
                     "has no point, through which the force acts and about which the part turns",
                     "point = [...], or fixed with all rotations");
  return part;
}

template <int dim>
problem::BoundaryCondition<dim> resolve(const BoundaryConfig& config)
{
  problem::BoundaryCondition<dim> boundary;
  boundary.name = config.name;
  boundary.where = config.where;
  boundary.contact = config.contact;
  if (config.contact) check_dimension<dim>(*config.contact);
  if (config.rigid) boundary.rigid = resolve<dim>(*config.rigid);
  if (config.pressure) boundary.pressure = in_dimension<dim>(*config.pressure);
  if (!config.traction.empty())
    boundary.traction = vector_of<dim>(config.traction, inside(config.where, "traction"));
  if (config.spring)
  {
    const SpringConfig& spring = *config.spring;
    boundary.spring.emplace(
        problem::Spring<dim>{in_dimension<dim>(spring.normal), in_dimension<dim>(spring.tangential)});
    if (!spring.rest.empty())
      boundary.spring->rest = vector_of<dim>(spring.rest, inside(spring.where, "rest"));
  }
  if (config.displacement.empty()) return boundary;
  check_length<dim>(config.displacement.size(), inside(config.where, "displacement"));
  for (int i = 0; i < dim; ++i)
    if (config.displacement[i]) boundary.displacement[i] = in_dimension<dim>(*config.displacement[i]);
  return boundary;
}

/// For each region, the entry with its name, else the entry without a name, else null.
template <class T>
std::vector<const T*> by_region(const std::vector<T>& entries, std::span<const std::string> regions)
{
  std::vector<const T*> found(regions.size(), nullptr);
  for (const T& entry : entries)
    if (entry.region.empty()) std::ranges::fill(found, &entry);
  for (const T& entry : entries)
    if (!entry.region.empty())
      found[problem::group_number(entry.region, regions, entry.where, "region")] = &entry;
  return found;
}

/// The entries of the initial stress; in plane strain zz may follow, of a body of revolution that around the
/// axis.
template <int dim>
void set_initial_stress(const LoadConfig& load, problem::PlaneModel plane, problem::Region<dim>& region)
{
  constexpr auto n = static_cast<std::size_t>(problem::n_symmetric<dim>);
  const std::vector<problem::Field>& given = load.initial_stress;
  const Where where = inside(load.where, "initial_stress");
  if (dim == 2 && given.size() == n + 1 && plane == problem::PlaneModel::stress)
    throw InputError(where, "has an entry zz beside plane = \"stress\", where sigma_zz is 0",
                     "three entries: [xx, yy, xy]");
  if (given.size() != n && !(dim == 2 && given.size() == n + 1))
    throw InputError(where, fmt::format("has {} entries in a case in {}D", given.size(), dim),
                     dim == 2
                         ? "three entries, [xx, yy, xy], in plane strain also [xx, yy, xy, zz]; of a body of "
                           "revolution [rr, zz, rz], also [rr, zz, rz, hoop]"
                         : "six entries: [xx, yy, zz, xy, yz, xz]");
  for (std::size_t i = 0; i < n; ++i) region.initial_stress[i] = in_dimension<dim>(given[i]);
  if (given.size() > n) region.initial_stress_zz = in_dimension<dim>(given[n]);
}

/// Sets what the case gives beside body forces.
template <int dim>
void set_thermal(const MaterialConfig& material, const LoadConfig& load, problem::Region<dim>& region)
{
  if (!load.initial_stress.empty()) set_initial_stress<dim>(load, material.plane, region);
  if (!load.temperature) return;
  if (!material.alpha)
    throw InputError(
        inside(load.where, "temperature"),
        fmt::format("the material of region \"{}\" has no alpha, by which it expands", region.name),
        "material.alpha, the strain per degree, such as 12e-6; 0 for none");
  region.temperature = in_dimension<dim>(*load.temperature);
  region.reference_temperature = in_dimension<dim>(load.reference_temperature);
}

/// Materials and loads of the case, for each region of the mesh.
template <int dim>
std::vector<problem::Region<dim>> regions_of(const Config& config, std::span<const std::string> names)
{
  for (const LoadConfig& load : config.loads)
    if (!load.body.empty()) (void)vector_of<dim>(load.body, inside(load.where, "body"));
  const auto materials = by_region(config.materials, names);
  const auto loads = by_region(config.loads, names);
  std::vector<problem::Region<dim>> regions;
  for (std::size_t r = 0; r < names.size(); ++r)
  {
    if (materials[r] == nullptr)
      throw InputError({.file = config.file, .key = "material"},
                       fmt::format("region \"{}\" of the mesh has no material", names[r]),
                       fmt::format("add [{}] with E and nu, or give E and nu in [material] for all regions",
                                   dotted_key("material", names[r])));
    if (dim == 3 && materials[r]->plane == problem::PlaneModel::stress)
      throw InputError(inside(materials[r]->where, "plane"), "plane stress in a 3D case",
                       "drop plane; it is for 2D cases");
    problem::Region<dim>& region = regions.emplace_back();
    region.name = names[r];
    region.material = problem::lame(materials[r]->E, materials[r]->nu, materials[r]->plane);
    region.material.expansion = materials[r]->alpha.value_or(0);
    if (loads[r] == nullptr) continue;
    if (!loads[r]->body.empty())
      region.body_force = vector_of<dim>(loads[r]->body, inside(loads[r]->where, "body"));
    set_thermal<dim>(*materials[r], *loads[r], region);
  }
  return regions;
}

/// The author of a mesh file names boundaries for a purpose, so omitting one from the case is a mistake. The
/// sides of a box and the faces of a CAD geometry have names whether they are needed or not.
template <int dim>
void check_all_mentioned(const Config& config, std::span<const std::string> groups)
{
  const auto* file = std::get_if<mesh::MeshFile>(&config.mesh);
  if (file == nullptr || mesh::has_named_entities(file->path)) return;
  const auto is_paired = [&](const std::string& group)
  {
    return std::ranges::any_of(config.contacts,
                               [&](const ContactConfig& contact)
                               {
                                 return std::ranges::find(contact.slave, group) != contact.slave.end() ||
                                        std::ranges::find(contact.master, group) != contact.master.end();
                               });
  };
  std::vector<std::string> forgotten;
  for (const std::string& group : groups)
    if (std::ranges::find(config.boundaries, group, &BoundaryConfig::name) == config.boundaries.end() &&
        !is_paired(group))
      forgotten.push_back(group);
  if (!forgotten.empty())
    throw InputError(
        {.file = config.file, .key = "boundary"},
        fmt::format("the case does not mention {} of the mesh: {}",
                    forgotten.size() == 1 ? "a boundary" : "boundaries", problem::quoted_list(forgotten)),
        fmt::format("if it is traction-free, say so: [{}] with traction = {}",
                    dotted_key("boundary", forgotten.front()), dim == 2 ? "[0, 0]" : "[0, 0, 0]"));
}

/// Throws for watched or prescribed quantities that the problem does not have, and where meshes cannot be
/// refined as requested.
template <int dim>
void check_history(const HistoryConfig& history, const problem::Problem<dim>& problem)
{
  if (history.refine == Refine::transfer)
    adapt::check_transfer<dim>(problem, inside(history.where, "refine"));
  const auto check = [&](const std::vector<adapt::Gauge>& gauges)
  {
    for (const adapt::Gauge& gauge : gauges) (void)adapt::gauged_boundary<dim>(problem, gauge);
  };
  check(history.program.displacement.gauges);
  if (history.program.then) check(history.program.then->gauges);
  for (const adapt::Watch& watch : history.watch) check(watch.gauges);
}

/// The indices of those names that exist.
std::vector<int> tags_of(std::span<const std::string> groups, std::span<const std::string> boundary_names)
{
  std::vector<int> tags;
  for (std::size_t g = 0; g < boundary_names.size(); ++g)
    if (std::ranges::find(groups, boundary_names[g]) != groups.end()) tags.push_back(static_cast<int>(g));
  return tags;
}

}  // namespace

template <int dim>
problem::Problem<dim> resolve(const Config& config, std::span<const std::string> region_names,
                              std::span<const std::string> boundary_names,
                              const mesh::QuadraticFacets* quadratic_facets)
{
  const auto facets = [&](std::span<const std::string> slave, std::span<const std::string> master = {}) {
    return ContactFacets{quadratic_facets, tags_of(slave, boundary_names), tags_of(master, boundary_names)};
  };
  const std::vector<problem::Region<dim>> regions = regions_of<dim>(config, region_names);
  std::vector<problem::BoundaryCondition<dim>> boundaries;
  for (const BoundaryConfig& boundary : config.boundaries)
  {
    (void)problem::group_number(boundary.name, boundary_names, boundary.where, "boundary");
    boundaries.push_back(resolve<dim>(boundary));
    if (boundaries.back().contact)
      apply_geometry<dim>(config, boundary.geometry, facets({&boundary.name, 1}), *boundaries.back().contact);
  }
  check_all_mentioned<dim>(config, boundary_names);
  std::vector<problem::ContactPair<dim>> pairs;
  for (const ContactConfig& contact : config.contacts)
  {
    pairs.push_back(resolve<dim>(contact));
    apply_geometry<dim>(config, contact.geometry, facets(contact.slave, contact.master),
                        pairs.back().contact);
  }
  problem::Problem<dim> problem(region_names, boundary_names, regions, boundaries, std::move(pairs));
  if (config.history) check_history<dim>(*config.history, problem);
  return config.is_axisymmetric ? problem.axisymmetric() : problem;
}

template <int dim>
Point<dim> moment_point(const OutputConfig& output, const mesh::Mesh<dim>& mesh)
{
  if (output.moment_about.empty()) return certify::centroid<dim>(mesh);
  if (output.moment_about.size() != dim)
    throw InputError(output.moment_about_where,
                     fmt::format("has {} numbers, the mesh is {}D", output.moment_about.size(), dim),
                     fmt::format("{} coordinates of a point", dim));
  return Point<dim>(output.moment_about.data());
}

namespace
{

std::string label(problem::QuantityKind kind, const io::CaseFacts& facts)
{
  switch (kind)
  {
    case problem::QuantityKind::energy:
    case problem::QuantityKind::load_work:
      return facts.label(problem::UnitOf::energy);
    case problem::QuantityKind::contact_force:
    case problem::QuantityKind::spring_force:
      return facts.label(problem::UnitOf::force);
    case problem::QuantityKind::contact_moment:
      return facts.label(problem::UnitOf::moment);
    case problem::QuantityKind::mean_displacement:
      return facts.label(problem::UnitOf::length);
    case problem::QuantityKind::safety_factor:
      return {};
  }
  return {};
}

}  // namespace

io::CaseFacts case_facts(const Config& config, int dimension)
{
  io::CaseFacts facts{.title = config.title,
                      .file = config.file,
                      .dimension = dimension,
                      .degree = config.method.degree,
                      .stress = config.method.stress,
                      .friction = friction_name(config),
                      .gamma0 = config.method.gamma_0(),
                      .units = config.units,
                      .purpose = config.purpose,
                      .not_covered = config.not_covered,
                      .is_axisymmetric = config.is_axisymmetric};
  for (const QuantityConfig& quantity : config.quantities)
    facts.quantity_units.emplace_back(quantity.name, label(quantity.kind, facts));
  return facts;
}

template problem::Problem<2> resolve(const Config&, std::span<const std::string>,
                                     std::span<const std::string>, const mesh::QuadraticFacets*);
template problem::Problem<3> resolve(const Config&, std::span<const std::string>,
                                     std::span<const std::string>, const mesh::QuadraticFacets*);
template Point<2> moment_point(const OutputConfig&, const mesh::Mesh<2>&);
template Point<3> moment_point(const OutputConfig&, const mesh::Mesh<3>&);

}  // namespace tribound::case_file
