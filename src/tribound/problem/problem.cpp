#include "tribound/problem/problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <string_view>
#include <utility>

#include "tribound/problem/nonnegative.h"

namespace tribound::problem
{

namespace
{

/// The entry of each region: the one with its name, else the one without a name.
template <int dim>
std::vector<Region<dim>> of_each_region(std::span<const std::string> names,
                                        const std::vector<Region<dim>>& entries)
{
  std::vector<const Region<dim>*> found(names.size(), nullptr);
  for (const Region<dim>& entry : entries)
    if (entry.name.empty()) std::ranges::fill(found, &entry);
  for (const Region<dim>& entry : entries)
    if (!entry.name.empty()) found[group_number(entry.name, names, {}, "region")] = &entry;
  std::vector<Region<dim>> regions;
  for (std::size_t r = 0; r < names.size(); ++r)
  {
    if (found[r] == nullptr)
      throw InputError({}, fmt::format("region \"{}\" of the mesh has no material", names[r]),
                       "give it one, or one without a name for all regions");
    regions.push_back(*found[r]);
    regions.back().name = names[r];
  }
  return regions;
}

template <int dim>
std::vector<BoundaryCondition<dim>> of_each_boundary(std::span<const std::string> names,
                                                     const std::vector<BoundaryCondition<dim>>& conditions)
{
  std::vector<BoundaryCondition<dim>> boundaries(names.size());
  for (const BoundaryCondition<dim>& condition : conditions)
  {
    BoundaryCondition<dim>& boundary =
        boundaries[group_number(condition.name, names, condition.where, "boundary")];
    if (!boundary.name.empty())
      throw InputError(condition.where, fmt::format("boundary \"{}\" has two conditions", condition.name),
                       "give all that holds on a boundary in one");
    boundary = condition;
  }
  for (std::size_t i = 0; i < names.size(); ++i) boundaries[i].name = names[i];
  return boundaries;
}

/// The side of each boundary. A boundary is in at most one pair, on one side, and then has no condition.
template <int dim>
std::vector<PairSide> sides_of(std::span<const std::string> names,
                               const std::vector<BoundaryCondition<dim>>& conditions,
                               std::span<const ContactPair<dim>> pairs)
{
  std::vector<PairSide> sides(names.size());
  const auto take = [&](const std::string& name, const PairSide& side)
  {
    const Where& where = pairs[side.pair].where;
    PairSide& of_boundary = sides[group_number(name, names, where, "boundary")];
    if (of_boundary.pair >= 0)
      throw InputError(where, fmt::format("boundary \"{}\" already is in contact", name),
                       "a boundary is the slave or the master of one contact; split the group in the mesh");
    of_boundary = side;
    if (std::ranges::find(conditions, name, &BoundaryCondition<dim>::name) != conditions.end())
      throw InputError(where, fmt::format("boundary \"{}\" has a condition of its own", name),
                       "where bodies touch, nothing else holds; split the group in the mesh");
  };
  for (int k = 0; k < static_cast<int>(pairs.size()); ++k)
  {
    const ContactPair<dim>& pair = pairs[k];
    if (pair.slave.empty() || pair.master.empty())
      throw InputError(pair.where, "a side of the contact is empty", "name its boundaries");
    for (const std::string& name : pair.slave) take(name, {k, true});
    for (const std::string& name : pair.master) take(name, {k, false});
    if (cone(pair.contact.law).is_tied && !(pair.contact.gap && pair.contact.gap->is_zero()))
      throw InputError(pair.where, "a tied contact has no gap", "give the gap 0");
    if (cone(pair.contact.law).is_tied && pair.contact.water)
      throw InputError(pair.where, "a tied contact has no water in it", "an interface instead");
  }
  return sides;
}

}  // namespace

std::string quoted_list(std::span<const std::string> names)
{
  return names.empty() ? "none" : fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

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

template <int dim>
Tensor<dim> symmetric_unit(int i)
{
  constexpr std::array<std::array<int, 2>, 3> off_diagonal = {{{0, 1}, {1, 2}, {0, 2}}};
  Tensor<dim> result = Tensor<dim>::Zero();
  const auto [r, c] = i < dim ? std::array{i, i} : off_diagonal[i - dim];
  result(r, c) = result(c, r) = 1;
  return result;
}

template <int dim>
bool Region<dim>::has_initial_stress() const
{
  const bool is_heated =
      material.expansion != 0 && !(temperature.is_zero() && reference_temperature.is_zero());
  return is_heated || !initial_stress_zz.is_zero() || !std::ranges::all_of(initial_stress, &Field::is_zero);
}

template <int dim>
double strength_at(const ContactLaw& law, const Point<dim>& x)
{
  const Field* strength = cone(law).strength;
  return strength == nullptr ? 0.0 : nonnegative_at<dim>(*strength, x);
}

template <int dim>
Problem<dim>::Problem(std::span<const std::string> region_names, std::span<const std::string> boundary_names,
                      const std::vector<Region<dim>>& regions,
                      const std::vector<BoundaryCondition<dim>>& boundaries,
                      std::vector<ContactPair<dim>> pairs)
    : regions_(of_each_region(region_names, regions)),
      boundaries_(of_each_boundary(boundary_names, boundaries)),
      pairs_(std::move(pairs)),
      sides_(sides_of<dim>(boundary_names, boundaries, pairs_))
{
  for (const BoundaryCondition<dim>& boundary : boundaries_)
    if (boundary.spring)
      for (const Field* stiffness : {&boundary.spring->normal, &boundary.spring->tangential})
        refuse_time(*stiffness);
}

template <int dim>
bool Problem<dim>::is_in_contact(int tag) const
{
  return boundary(tag).contact || (tag >= 0 && sides_[tag].pair >= 0);
}

template <int dim>
const ContactPair<dim>* Problem<dim>::pair_of_slave(int tag) const
{
  return tag >= 0 && sides_[tag].pair >= 0 && sides_[tag].is_slave ? &pairs_[sides_[tag].pair] : nullptr;
}

template <int dim>
const ContactPair<dim>* Problem<dim>::pair_of_master(int tag) const
{
  return tag >= 0 && sides_[tag].pair >= 0 && !sides_[tag].is_slave ? &pairs_[sides_[tag].pair] : nullptr;
}

template <int dim>
const Contact* Problem<dim>::contact(int tag) const
{
  if (boundary(tag).contact) return &*boundary(tag).contact;
  const ContactPair<dim>* pair = pair_of_slave(tag);
  return pair == nullptr ? nullptr : &pair->contact;
}

template <int dim>
Point<dim> Problem<dim>::body_force(int region, const Point<dim>& x) const
{
  Point<dim> f;
  for (int i = 0; i < dim; ++i) f[i] = body_force(region)[i](x);
  return f;
}

template <int dim>
bool Problem<dim>::body_force_is_constant(int region) const
{
  return std::ranges::all_of(body_force(region), &Field::is_constant);
}

template <int dim>
int Problem<dim>::load_degree() const
{
  int degree = 0;
  for (const Region<dim>& region : regions_)
    for (const Field& f : region.body_force) degree = std::max(degree, f.degree());
  for (const BoundaryCondition<dim>& boundary : boundaries_)
  {
    for (const Field& g : boundary.traction) degree = std::max(degree, g.degree());
    if (boundary.pressure) degree = std::max(degree, boundary.pressure->degree());
  }
  return degree;
}

template <int dim>
int Problem<dim>::spring_load_degree() const
{
  int degree = 0;
  for (const BoundaryCondition<dim>& boundary : boundaries_)
  {
    if (!boundary.spring) continue;
    const int of_stiffness = std::max(boundary.spring->normal.degree(), boundary.spring->tangential.degree());
    for (const Field& rest : boundary.spring->rest)
      if (!rest.is_zero()) degree = std::max(degree, of_stiffness + rest.degree());
  }
  return degree;
}

template <int dim>
bool Problem<dim>::has_springs() const
{
  return std::ranges::any_of(boundaries_, [](const auto& boundary) { return boundary.spring.has_value(); });
}

template <int dim>
bool Problem<dim>::has_rigid_parts() const
{
  return std::ranges::any_of(boundaries_, [](const auto& boundary) { return boundary.rigid.has_value(); });
}

template <int dim>
bool Problem<dim>::body_force_is_zero(int region) const
{
  return std::ranges::all_of(body_force(region), &Field::is_zero);
}

template <int dim>
Tensor<dim> Problem<dim>::initial_stress(int region, const Point<dim>& x) const
{
  const Region<dim>& r = regions_[region];
  Tensor<dim> result = Tensor<dim>::Zero();
  if (r.material.expansion != 0)
    result.diagonal().array() -=
        thermal_modulus(r.material) * (r.temperature(x) - r.reference_temperature(x));
  for (int i = 0; i < n_symmetric<dim>; ++i)
    if (!r.initial_stress[i].is_zero()) result += r.initial_stress[i](x) * symmetric_unit<dim>(i);
  return result;
}

template <int dim>
double Problem<dim>::initial_stress_zz(int region, const Point<dim>& x) const
{
  const Region<dim>& r = regions_[region];
  if (dim == 3 || r.material.plane == PlaneModel::stress) return 0;
  const double warmer = r.material.expansion == 0 ? 0 : r.temperature(x) - r.reference_temperature(x);
  return r.initial_stress_zz(x) - thermal_modulus(r.material) * warmer;
}

template <int dim>
bool Problem<dim>::has_initial_stress() const
{
  return std::ranges::any_of(regions_, &Region<dim>::has_initial_stress);
}

template <int dim>
Problem<dim> Problem<dim>::without_initial_stress() const
{
  Problem result = *this;
  for (Region<dim>& region : result.regions_)
  {
    region.initial_stress = {};
    region.temperature = region.reference_temperature = region.initial_stress_zz = Field();
  }
  return result;
}

template <int dim>
template <class Self, class Visit>
void Problem<dim>::for_each_contact(Self& problem, const Visit& visit)
{
  for (auto& boundary : problem.boundaries_)
    if (boundary.contact) visit(*boundary.contact);
  for (auto& pair : problem.pairs_) visit(pair.contact);
}

template <int dim>
std::vector<const Contact*> Problem<dim>::contacts() const
{
  std::vector<const Contact*> result;
  for_each_contact(*this, [&result](const Contact& contact) { result.push_back(&contact); });
  return result;
}

template <int dim>
template <class Self, class Visit>
void Problem<dim>::for_each_datum(Self& problem, const Visit& visit)
{
  const auto of_contact = [&](auto& contact)
  {
    if (contact.gap) visit(*contact.gap);
    if (contact.broken) visit(*contact.broken);
    if (contact.normal)
      for (auto& component : contact.normal->components()) visit(component);
    if (auto* tresca = std::get_if<Tresca>(&contact.law)) visit(tresca->threshold);
    if (auto* joint = std::get_if<JointLaw>(&contact.law)) visit(joint->threshold);
  };
  for (auto& region : problem.regions_)
  {
    for (auto& component : region.body_force) visit(component);
    for (auto& component : region.initial_stress) visit(component);
    for (auto* datum : {&region.temperature, &region.reference_temperature, &region.initial_stress_zz})
      visit(*datum);
  }
  for (auto& boundary : problem.boundaries_)
  {
    for (auto& component : boundary.displacement)
      if (component) visit(*component);
    for (auto& component : boundary.traction) visit(component);
    if (boundary.pressure) visit(*boundary.pressure);
    if (boundary.rigid)
    {
      for (auto& component : boundary.rigid->force) visit(component);
      for (auto& component : boundary.rigid->moment) visit(component);
    }
    if (!boundary.spring) continue;
    visit(boundary.spring->normal);
    visit(boundary.spring->tangential);
    for (auto& component : boundary.spring->rest) visit(component);
  }
  for_each_contact(problem, of_contact);
}

template <int dim>
Problem<dim> Problem<dim>::at(double t) const
{
  Problem result = *this;
  for_each_datum(result, [t](Field& datum) { datum = datum.at(t); });
  for_each_contact(result,
                   [t](Contact& contact)
                   {
                     if (contact.water) contact.water = contact.water->at(t);
                   });
  return result;
}

template <int dim>
Problem<dim> Problem<dim>::axisymmetric() const
{
  assert(dim == 2);
  Problem result = *this;
  result.is_axisymmetric_ = true;
  for (BoundaryCondition<dim>& boundary : result.boundaries_)
    if (boundary.rigid)
      for (std::size_t i = 0; i < boundary.rigid->fixed.size(); ++i)
        if (i != 1) boundary.rigid->fixed[i] = true;
  return result;
}

template <int dim>
Problem<dim> Problem<dim>::with_crack_tips(std::span<const double> tips) const
{
  Problem result = *this;
  std::size_t i = 0;
  for_each_contact(result,
                   [&](Contact& contact)
                   {
                     const double tip = tips[i++];
                     if (contact.water) contact.water = contact.water->with_crack_tip(tip);
                   });
  return result;
}

template <int dim>
bool Problem<dim>::uses_time() const
{
  bool found = false;
  for_each_datum(*this, [&found](const Field& datum) { found = found || datum.uses_time(); });
  for_each_contact(*this, [&found](const Contact& contact)
                   { found = found || (contact.water && contact.water->uses_time()); });
  return found;
}

template <int dim>
bool Problem<dim>::has_contact() const
{
  return !pairs_.empty() ||
         std::ranges::any_of(boundaries_, [](const auto& boundary) { return boundary.contact.has_value(); });
}

template Tensor<2> symmetric_unit<2>(int);
template Tensor<3> symmetric_unit<3>(int);
template struct Region<2>;
template struct Region<3>;
template class Problem<2>;
template class Problem<3>;
template double strength_at<2>(const ContactLaw&, const Point<2>&);
template double strength_at<3>(const ContactLaw&, const Point<3>&);

}  // namespace tribound::problem
