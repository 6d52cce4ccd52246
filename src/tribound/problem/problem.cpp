#include "tribound/problem/problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tribound/case/node.h"
#include "tribound/problem/formula.h"

namespace tribound::problem
{

namespace
{

/// "a", "b", "c", each in quotes.
std::string quoted_list(std::span<const std::string> names)
{
  return names.empty() ? "none" : fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

/// The position of `name`, found at `where`, among the groups of the mesh.
int group_number(const std::string& name, std::span<const std::string> groups, const Where& where,
                 std::string_view kind)
{
  const auto it = std::ranges::find(groups, name);
  if (it != groups.end()) return static_cast<int>(it - groups.begin());
  const std::string near = closest(name, groups);
  throw InputError(where, fmt::format("the mesh has no {} \"{}\"", kind, name),
                   fmt::format("{}it has {}", near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                               quoted_list(groups)));
}

Where inside(const Where& table, std::string_view key)
{
  Where where = table;
  where.key += fmt::format(".{}", key);
  return where;
}

template <int dim>
void check_length(std::size_t size, const Where& where)
{
  if (size != dim)
    throw InputError(where, fmt::format("has {} components, but the mesh is {}D", size, dim),
                     fmt::format("give {}", dim));
}

template <int dim>
Expression in_dimension(const Expression& expression)
{
  if (dim == 2 && expression.uses_z())
    throw InputError(expression.where(), "uses z in a 2D case", "only x and y vary");
  return expression;
}

template <int dim>
std::array<Expression, dim> vector_of(std::span<const Expression> components, const Where& where)
{
  check_length<dim>(components.size(), where);
  std::array<Expression, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = in_dimension<dim>(components[i]);
  return result;
}

/// The value at x, which must not be negative.
template <int dim>
double nonnegative_at(const Expression& expression, const Point<dim>& x)
{
  constexpr double rounding = 1e-12;  // of a point on a facet, relative to its coordinates
  const double value = expression(x);
  if (value >= 0) return value;
  if (expression.around({x.data(), dim}, rounding * x.template lpNorm<Eigen::Infinity>()).upper < 0)
    throw InputError(expression.where(),
                     fmt::format("is negative, {:.9g}, at the point ({:.9g})", value,
                                 fmt::join(x.data(), x.data() + dim, ", ")),
                     nonnegative_hint(expression.where()));
  return 0;
}

template <int dim>
void check_contact(const case_file::Contact& contact)
{
  (void)in_dimension<dim>(contact.gap);
  if (const auto* tresca = std::get_if<case_file::Tresca>(&contact.friction))
    (void)in_dimension<dim>(tresca->threshold);
}

template <int dim>
BoundaryCondition<dim> resolve(const case_file::BoundaryConfig& config)
{
  BoundaryCondition<dim> boundary;
  boundary.name = config.name;
  boundary.where = config.where;
  boundary.contact = config.contact;
  if (config.contact) check_contact<dim>(*config.contact);
  if (config.pressure) boundary.pressure = in_dimension<dim>(*config.pressure);
  if (!config.traction.empty())
    boundary.traction = vector_of<dim>(config.traction, inside(config.where, "traction"));
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
    if (!entry.region.empty()) found[group_number(entry.region, regions, entry.where, "region")] = &entry;
  return found;
}

template <int dim>
std::vector<Material> resolve_materials(const case_file::Config& config, std::span<const std::string> regions)
{
  const auto found = by_region(config.materials, regions);
  std::vector<Material> materials;
  for (std::size_t r = 0; r < regions.size(); ++r)
  {
    if (found[r] == nullptr)
      throw InputError({.file = config.file, .key = "material"},
                       fmt::format("region \"{}\" of the mesh has no material", regions[r]),
                       fmt::format("add [{}] with E and nu, or give E and nu in [material] for all regions",
                                   case_file::dotted_key("material", regions[r])));
    if (dim == 3 && found[r]->plane == case_file::PlaneModel::stress)
      throw InputError(inside(found[r]->where, "plane"), "plane stress in a 3D case",
                       "drop plane; it is for 2D cases");
    materials.push_back(lame(found[r]->E, found[r]->nu, found[r]->plane));
  }
  return materials;
}

template <int dim>
std::vector<std::array<Expression, dim>> resolve_body_forces(const case_file::Config& config,
                                                             std::span<const std::string> regions)
{
  for (const case_file::LoadConfig& load : config.loads) (void)vector_of<dim>(load.body, load.where);
  std::vector<std::array<Expression, dim>> forces;
  for (const case_file::LoadConfig* load : by_region(config.loads, regions))
    forces.push_back(load == nullptr ? std::array<Expression, dim>{}
                                     : vector_of<dim>(load->body, load->where));
  return forces;
}

/// Boundaries of a mesh file are named by its author for a purpose: one that the case forgets is a mistake.
/// The sides of a box have names whether they are needed or not.
template <int dim>
void check_all_mentioned(const case_file::Config& config, std::span<const std::string> groups)
{
  if (std::holds_alternative<case_file::BoxMesh>(config.mesh)) return;
  std::vector<std::string> forgotten;
  for (const std::string& group : groups)
    if (std::ranges::find(config.boundaries, group, &case_file::BoundaryConfig::name) ==
        config.boundaries.end())
      forgotten.push_back(group);
  if (!forgotten.empty())
    throw InputError(
        {.file = config.file, .key = "boundary"},
        fmt::format("the case does not mention {} of the mesh: {}",
                    forgotten.size() == 1 ? "a boundary" : "boundaries", quoted_list(forgotten)),
        fmt::format("if it is traction-free, say so: [{}] with traction = {}",
                    case_file::dotted_key("boundary", forgotten.front()), dim == 2 ? "[0, 0]" : "[0, 0, 0]"));
}

template <int dim>
std::vector<BoundaryCondition<dim>> resolve_boundaries(const case_file::Config& config,
                                                       std::span<const std::string> groups)
{
  std::vector<BoundaryCondition<dim>> boundaries(groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) boundaries[i].name = groups[i];
  for (const case_file::BoundaryConfig& boundary : config.boundaries)
    boundaries[group_number(boundary.name, groups, boundary.where, "boundary")] = resolve<dim>(boundary);
  check_all_mentioned<dim>(config, groups);
  return boundaries;
}

}  // namespace

Material lame(double E, double nu, case_file::PlaneModel plane)
{
  const double mu = E / (2 * (1 + nu));
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  if (plane == case_file::PlaneModel::strain) return {lambda, mu};
  return {2 * lambda * mu / (lambda + 2 * mu), mu, plane};
}

template <int dim>
bool BoundaryCondition<dim>::fixes_any() const
{
  return std::ranges::any_of(displacement, [](const auto& component) { return component.has_value(); });
}

template <int dim>
bool BoundaryCondition<dim>::is_loaded() const
{
  const bool pressed = pressure && !pressure->is_zero();
  for (int i = 0; i < dim; ++i)
    if (!fixes(i) && (pressed || !traction[i].is_zero())) return true;
  return false;
}

template <int dim>
Point<dim> BoundaryCondition<dim>::load(const Point<dim>& x, const Point<dim>& n) const
{
  const double p = pressure ? (*pressure)(x) : 0.0;
  Point<dim> g;
  for (int i = 0; i < dim; ++i) g[i] = fixes(i) ? 0.0 : traction[i](x) - p * n[i];
  return g;
}

template <int dim>
double gap_at(const case_file::Contact& contact, const Point<dim>& x)
{
  return nonnegative_at<dim>(contact.gap, x);
}

template <int dim>
double threshold_at(const case_file::Tresca& law, const Point<dim>& x)
{
  return nonnegative_at<dim>(law.threshold, x);
}

template <int dim>
Problem<dim>::Problem(const case_file::Config& config, std::span<const std::string> region_names,
                      std::span<const std::string> boundary_names)
    : region_names_(region_names.begin(), region_names.end()),
      materials_(resolve_materials<dim>(config, region_names)),
      body_(resolve_body_forces<dim>(config, region_names)),
      boundaries_(resolve_boundaries<dim>(config, boundary_names))
{
}

template <int dim>
Point<dim> Problem<dim>::body_force(int region, const Point<dim>& x) const
{
  Point<dim> f;
  for (int i = 0; i < dim; ++i) f[i] = body_[region][i](x);
  return f;
}

template <int dim>
bool Problem<dim>::body_force_is_constant(int region) const
{
  return std::ranges::all_of(body_[region], &Expression::is_constant);
}

template <int dim>
bool Problem<dim>::body_force_is_zero(int region) const
{
  return std::ranges::all_of(body_[region], &Expression::is_zero);
}

template <int dim>
bool Problem<dim>::has_contact() const
{
  return std::ranges::any_of(boundaries_, [](const auto& boundary) { return boundary.contact.has_value(); });
}

template struct BoundaryCondition<2>;
template struct BoundaryCondition<3>;
template class Problem<2>;
template class Problem<3>;
template double gap_at<2>(const case_file::Contact&, const Point<2>&);
template double gap_at<3>(const case_file::Contact&, const Point<3>&);
template double threshold_at<2>(const case_file::Tresca&, const Point<2>&);
template double threshold_at<3>(const case_file::Tresca&, const Point<3>&);

}  // namespace tribound::problem
