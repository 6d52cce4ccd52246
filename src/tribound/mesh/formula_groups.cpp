#include "tribound/mesh/formula_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/verify.h"
#include "tribound/problem/formula.h"
#include "tribound/problem/formula_text.h"

namespace tribound::mesh
{

namespace
{

constexpr std::array<std::string_view, 3> normal_names = {"nx", "ny", "nz"};

/// The text with numbers in place of nx, ny, nz; whether it has any.
std::pair<std::string, bool> with_normal(const std::string& text, const Point<3>& normal)
{
  std::string result;
  bool has_normal = false;
  for (std::size_t i = 0; i < text.size();)
  {
    std::size_t end = i;
    while (end < text.size() && problem::is_name_character(text[end])) ++end;
    const std::string_view word = std::string_view(text).substr(i, std::max<std::size_t>(end - i, 1));
    const auto component = std::ranges::find(normal_names, word);
    if (component == normal_names.end())
      result += word;
    else
      result += fmt::format("({:.17g})", normal[component - normal_names.begin()]);
    has_normal = has_normal || component != normal_names.end();
    i += word.size();
  }
  return {result, has_normal};
}

/// The condition of a region knows no normal, and fails at its name.
problem::Formula parsed(const FormulaGroup& group, const Point<3>& normal)
{
  return {group.is_region ? group.condition : with_normal(group.condition, normal).first, group.where};
}

/// The condition of a group, evaluated.
template <int dim>
class Condition
{
 public:
  explicit Condition(const FormulaGroup& group) : group_(group)
  {
    formula_.emplace(parsed(group, Point<3>::UnitX()));
    has_normal_ = !group.is_region && with_normal(group.condition, Point<3>::UnitX()).second;
    if (dim == 2 && formula_->uses(2))
      throw InputError(group.where, "uses z in a 2D case", "only x and y vary");
    if (formula_->uses_time())
      throw InputError(group.where, "uses t, but a group is the same at all times", "only the place varies");
  }

  void set_normal(const Point<dim>& normal)
  {
    if (!has_normal_) return;
    Point<3> n = Point<3>::Zero();
    n.template head<dim>() = normal;
    formula_.emplace(parsed(group_, n));
  }

  [[nodiscard]] bool holds_at(const Point<dim>& x) const
  {
    const double value = (*formula_)(std::span<const double>(x.data(), dim));
    if (std::isnan(value)) throw InputError(group_.where, fmt::format("has no value at {}", describe(x)));
    return value != 0;
  }

 private:
  const FormulaGroup& group_;
  std::optional<problem::Formula> formula_{};
  bool has_normal_ = false;
};

/// The tag of a new group. Throws for a name that exists.
int add_name(const FormulaGroup& group, std::vector<std::string>& names, std::string_view kind)
{
  if (std::ranges::find(names, group.name) != names.end())
    throw InputError(group.where, fmt::format("the mesh has a {} \"{}\" already", kind, group.name),
                     "where makes a new one: another name, or no where");
  names.push_back(group.name);
  return static_cast<int>(names.size()) - 1;
}

/// The numbers of the groups `of`.
std::vector<char> sources_of(const FormulaGroup& group, std::span<const std::string> names,
                             std::string_view kind)
{
  std::vector<char> is_source(names.size(), 0);
  for (const std::string& name : group.of)
  {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      throw InputError(group.where, fmt::format("there is no {} \"{}\" to take it from", kind, name),
                       fmt::format("of = one or several of {}", fmt::join(names, ", ")));
    is_source[found - names.begin()] = 1;
  }
  return is_source;
}

[[noreturn]] void throw_empty(const FormulaGroup& group, std::string_view things, std::size_t n_candidates,
                              const std::string& example, const std::string& elsewhere)
{
  throw InputError(group.where,
                   n_candidates == 0
                       ? fmt::format("there are no {} for \"{}\"{}", things, group.name,
                                     group.of.empty() ? ": all are in groups" : "")
                       : fmt::format("none of {} {} satisfies the condition of \"{}\", such as not the {}",
                                     n_candidates, things, group.name, example),
                   elsewhere.empty() ? "are its lengths in the unit of the mesh?"
                                     : fmt::format("of = \"{}\" takes it from there", elsewhere));
}

/// Leaves out names of `of` that nothing has any more.
void drop_emptied(std::vector<std::string>& names, const std::vector<char>& is_source,
                  std::span<int* const> tags)
{
  std::vector<int> n(names.size(), 0);
  for (const int* tag : tags)
    if (*tag >= 0) ++n[*tag];
  std::vector<int> place(names.size(), -1);
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    if (n[i] == 0 && i < is_source.size() && is_source[i] != 0) continue;
    place[i] = static_cast<int>(kept.size());
    kept.push_back(names[i]);
  }
  for (int* tag : tags)
    if (*tag >= 0) *tag = place[*tag];
  names = std::move(kept);
}

template <int dim>
void add_region_groups(MeshData<dim>& data, std::span<const FormulaGroup> groups)
{
  const std::vector<int> before = data.regions;
  const std::vector<std::string> names = data.region_names;
  std::vector<char> is_emptied(names.size(), 0);
  for (const FormulaGroup& group : groups)
  {
    if (!group.is_region) continue;
    if (group.of.empty() && names.size() > 1)
      throw InputError(group.where, fmt::format("the mesh has several regions: {}", fmt::join(names, ", ")),
                       "of = the one from which it is taken");
    const std::vector<char> is_source =
        group.of.empty() ? std::vector<char>{1} : sources_of(group, names, "region");
    const int tag = add_name(group, data.region_names, "region");
    const Condition<dim> condition(group);
    std::size_t n = 0;
    std::size_t n_candidates = 0;
    std::size_t example = 0;
    for (std::size_t c = 0; c < before.size(); ++c)
    {
      if (is_source[before[c]] == 0) continue;
      ++n_candidates;
      example = c;
      Point<dim> centre = Point<dim>::Zero();
      for (const Index v : data.cells[c]) centre += data.vertices[v] / (dim + 1);
      if (!condition.holds_at(centre)) continue;
      if (data.regions[c] != before[c])
        throw InputError(group.where,
                         fmt::format("{} would be in region \"{}\", too",
                                     describe_cell(data, static_cast<Index>(c)), group.name),
                         "conditions that exclude each other");
      data.regions[c] = tag;
      ++n;
    }
    if (n == 0)
      throw_empty(group, "cells", n_candidates, describe_cell(data, static_cast<Index>(example)), {});
    for (std::size_t i = 0; i < names.size(); ++i) is_emptied[i] |= is_source[i];
  }
  std::vector<int*> tags;
  tags.reserve(data.regions.size());
  for (int& tag : data.regions) tags.push_back(&tag);
  drop_emptied(data.region_names, is_emptied, tags);
}

/// The groups of facets.
template <int dim>
class FacetGroups
{
 public:
  explicit FacetGroups(MeshData<dim>& data)
      : data_(data),
        topology_(build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells)),
        names_(data.boundary_names)
  {
    std::vector<char> is_named(topology_.facets.size(), 0);
    for (const TaggedFacet<dim>& tagged : data.facets)
    {
      tags_before_.push_back(tagged.tag);
      if (const Index f = topology_.facet(tagged.vertices); f >= 0) is_named[f] = 1;
    }
    for (std::size_t f = 0; f < is_named.size(); ++f)
      if (is_named[f] == 0 && topology_.facet_cells[f][1] < 0)
        data.facets.push_back({topology_.facets[f], unnamed});
    tags_before_.resize(data.facets.size(), unnamed);
  }

  void add(const FormulaGroup& group)
  {
    const std::vector<char> is_source = sources_of(group, names_, "boundary");
    const int tag = add_name(group, data_.boundary_names, "boundary");
    Condition<dim> condition(group);
    std::size_t n = 0;
    std::size_t n_candidates = 0;
    std::size_t example = 0;
    std::string elsewhere;
    for (std::size_t k = 0; k < data_.facets.size(); ++k)
    {
      const int before = tags_before_[k];
      const bool is_candidate = group.of.empty() ? before == unnamed : before >= 0 && is_source[before] != 0;
      if (!is_candidate && !(group.of.empty() && elsewhere.empty())) continue;
      const bool holds = satisfies(condition, data_.facets[k].vertices);
      if (!is_candidate && holds) elsewhere = names_[before];
      if (!is_candidate) continue;
      ++n_candidates;
      example = k;
      if (!holds) continue;
      if (data_.facets[k].tag != before)
        throw InputError(
            group.where,
            fmt::format("{} is in boundary \"{}\", too", describe_facet<dim>(data_, data_.facets[k].vertices),
                        data_.boundary_names[data_.facets[k].tag]),
            "conditions that exclude each other");
      data_.facets[k].tag = tag;
      ++n;
    }
    if (n == 0)
      throw_empty(group, "facets", n_candidates, describe_facet<dim>(data_, data_.facets[example].vertices),
                  elsewhere);
    is_emptied_.resize(names_.size(), 0);
    for (std::size_t i = 0; i < names_.size(); ++i) is_emptied_[i] |= is_source[i];
  }

  void finish()
  {
    std::erase_if(data_.facets, [](const TaggedFacet<dim>& facet) { return facet.tag == unnamed; });
    std::vector<int*> tags;
    tags.reserve(data_.facets.size());
    for (TaggedFacet<dim>& facet : data_.facets) tags.push_back(&facet.tag);
    drop_emptied(data_.boundary_names, is_emptied_, tags);
  }

 private:
  static constexpr int unnamed = -1;

  bool satisfies(Condition<dim>& condition, const std::array<Index, dim>& facet) const
  {
    if (const Index f = topology_.facet(facet); f >= 0)
    {
      const Index cell = topology_.facet_cells[f][0];
      condition.set_normal(outward_normal(cell, topology_.local_facet(cell, f)));
    }
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : facet) centre += data_.vertices[v] / dim;
    return condition.holds_at(centre) &&
           std::ranges::all_of(facet, [&](Index v) { return condition.holds_at(data_.vertices[v]); });
  }

  /// Of a cell whose orientation is not known yet.
  [[nodiscard]] Point<dim> outward_normal(Index cell, int local) const
  {
    const std::array<Index, dim> v = facet_vertices(data_.cells[cell], local);
    const Point<dim>& a = data_.vertices[v[0]];
    Point<dim> normal;
    if constexpr (dim == 2)
      normal = Point<2>(data_.vertices[v[1]][1] - a[1], a[0] - data_.vertices[v[1]][0]);
    else
      normal = Point<3>(data_.vertices[v[1]] - a).cross(Point<3>(data_.vertices[v[2]] - a));
    const bool is_inward = normal.dot(data_.vertices[data_.cells[cell][local]] - a) > 0;
    return (is_inward ? -1 : 1) * normal.normalized();
  }

  MeshData<dim>& data_;
  Topology<dim> topology_;
  std::vector<std::string> names_;  ///< of the file
  std::vector<int> tags_before_{};
  std::vector<char> is_emptied_{};
};

}  // namespace

void check_condition(const FormulaGroup& group)
{
  (void)parsed(group, Point<3>::UnitX());
}

template <int dim>
void add_groups(MeshData<dim>& data, std::span<const FormulaGroup> groups)
{
  if (groups.empty()) return;
  check_arrays(data);
  add_region_groups<dim>(data, groups);
  if (std::ranges::all_of(groups, &FormulaGroup::is_region)) return;
  FacetGroups<dim> facets(data);
  for (const FormulaGroup& group : groups)
    if (!group.is_region) facets.add(group);
  facets.finish();
}

template void add_groups(MeshData<2>&, std::span<const FormulaGroup>);
template void add_groups(MeshData<3>&, std::span<const FormulaGroup>);

}  // namespace tribound::mesh
