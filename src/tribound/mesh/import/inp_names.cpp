#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "tribound/base/sorted.h"
#include "tribound/mesh/import/cell_sets.h"
#include "tribound/mesh/import/inp_assembler.h"

namespace tribound::mesh
{

void InpAssembler::add_members(const InpMembers& members, std::size_t i, const InpPlace& place,
                               std::vector<Index>& places, std::vector<ResolvedSet> Instance::*resolved,
                               NumberIndex Instance::*index)
{
  constexpr std::size_t most = 200'000'000;
  const Instance& owner = instances_[members.instance < 0 ? i : members.instance];
  if (members.set >= 0)
  {
    const std::vector<Index>& other = (owner.*resolved)[members.set].members;
    places.insert(places.end(), other.begin(), other.end());
    n_members_ += other.size();
  }
  else
  {
    const auto found = (owner.*index).range(members.first, members.last);
    n_members_ += found.size();
    if (!members.may_miss && std::ssize(found) != members.last - members.first + 1)
    {
      std::int64_t missing = members.first;
      for (const auto& [number, _] : found) missing += number == missing ? 1 : 0;
      lines_.fail(
          place, fmt::format("{} {} is not defined", index == &Instance::nodes ? "node" : "element", missing),
          "is the deck complete?");
    }
    for (const auto& [number, where] : found)
      if ((number - members.first) % members.step == 0) places.push_back(where);
  }
  if (n_members_ > most)
    lines_.fail(place, fmt::format("the sets of the deck have more than {} members", most),
                "take out sets that are not needed");
}

void InpAssembler::resolve(std::size_t i, InpSets InpPart::*sets,
                           std::vector<ResolvedSet> Instance::*resolved, NumberIndex Instance::*index)
{
  for (const InpSet& set : (part_of(i).*sets).all)
  {
    std::vector<Index> places;
    for (const InpMembers& members : set.members) add_members(members, i, set.place, places, resolved, index);
    sort_and_unite(places);
    (instances_[i].*resolved).push_back({full_name(i, set.name), &set, std::move(places)});
  }
}

void InpAssembler::mark_sets(std::size_t i)
{
  for (const InpSection& section : part_of(i).sections)
  {
    ResolvedSet& set = instances_[i].element_sets[section.set];
    if (section.keyword == "SOLID SECTION")
      set.is_section = true;
    else if (!set.members.empty() && !options_.ignores_elements)
      lines_.fail(
          section.place,
          fmt::format("element {} is in a *{}", elements_[set.members[0]].label, section.keyword),
          "shells, membranes and beams have no counterpart: model them by solids, or leave them out by "
          "ignore_elements = true");
  }
  for (const InpSurface& surface : part_of(i).surfaces)
    for (const InpSurfacePart& part : surface.parts)
      if (!surface.is_of_nodes && part.elements.set >= 0)
        instances_[part.elements.instance < 0 ? i : part.elements.instance]
            .element_sets[part.elements.set]
            .is_of_surface = true;
}

FaceNodes InpAssembler::face_of(const Element& element, int face, const InpPlace& place) const
{
  if (!element.is_cell)
    lines_.fail(
        place,
        fmt::format("element {} ({}) is not a cell of the mesh", element.label, element.elements->type_name),
        "surfaces are faces of solids, or edges of plane elements");
  const ShapeTable& table = table_of(element.elements->type.shape);
  if (face >= table.n_faces)
    lines_.fail(
        place,
        fmt::format("element {} ({}) has no face S{}", element.label, element.elements->type_name, face + 1),
        fmt::format("S1 to S{}", table.n_faces));
  const auto block =
      static_cast<int>(std::ranges::upper_bound(first_cell_, element.number) - first_cell_.begin()) - 1;
  return nodes_of(mesh_.cells, {{}, block, element.number - first_cell_[block], face});
}

InpSurfaceMembers InpAssembler::members_of(std::size_t i, const InpSurface& surface)
{
  InpSurfaceMembers result;
  std::vector<Index> places;
  for (const InpSurfacePart& part : surface.parts)
  {
    if (surface.is_of_nodes)
    {
      add_members(part.elements, i, part.place, result.nodes, &Instance::node_sets, &Instance::nodes);
      continue;
    }
    places.clear();
    add_members(part.elements, i, part.place, places, &Instance::element_sets, &Instance::elements);
    for (const Index e : places)
    {
      if (!elements_[e].is_cell && options_.ignores_elements) continue;
      result.faces.push_back(face_of(elements_[e], part.face, part.place));
      result.labels.push_back(elements_[e].label);
    }
  }
  if (result.faces.empty() && result.nodes.empty() && places.empty())
    lines_.fail(surface.place, fmt::format("surface \"{}\" is empty", surface.name));
  sort_and_unite(result.nodes);
  return result;
}

void InpAssembler::add_surface(std::size_t i, const InpSurface& surface)
{
  const std::string name = full_name(i, surface.name);
  InpSurfaceMembers members = members_of(i, surface);
  if (surface.is_of_nodes)
  {
    mesh_.node_sets.push_back({name, std::move(members.nodes), true});
    return;
  }
  if (members.faces.empty()) return;  // all of elements that are ignored
  FacetSet facets{name};
  for (std::size_t f = 0; f < members.faces.size(); ++f)
    append(facets.facets, members.faces[f], members.labels[f]);
  mesh_.facet_sets.push_back(std::move(facets));
}

std::vector<Index> InpAssembler::members_named(std::string_view field, const InpPlace& place,
                                               InpSets InpPart::*sets,
                                               std::vector<ResolvedSet> Instance::*resolved,
                                               NumberIndex Instance::*index)
{
  const std::optional<InpMembers> members = model_.find_members(field, 0, -1, sets);
  if (!members)
    lines_.fail(place, fmt::format("there is no set \"{}\"", field.substr(0, 80)), "is the deck complete?");
  std::vector<Index> places;
  add_members(*members, 0, place, places, resolved, index);
  if (places.empty())
    lines_.fail(place, fmt::format("the set \"{}\" is empty", field.substr(0, 80)),
                "a set lists its members, or names sets before it");
  sort_and_unite(places);
  return places;
}

std::vector<Index> InpAssembler::nodes_named(std::string_view field, const InpPlace& place)
{
  return members_named(field, place, &InpPart::node_sets, &Instance::node_sets, &Instance::nodes);
}

std::vector<Index> InpAssembler::elements_named(std::string_view field, const InpPlace& place)
{
  return members_named(field, place, &InpPart::element_sets, &Instance::element_sets, &Instance::elements);
}

std::pair<std::string, InpSurfaceMembers> InpAssembler::surface_named(std::string_view field,
                                                                      const InpPlace& place)
{
  const std::string wanted = capitals(field);
  for (std::size_t i = 0; i < model_.instances.size(); ++i)
    for (const InpSurface& surface : part_of(i).surfaces)
      if (const std::string name = full_name(i, surface.name); capitals(name) == wanted)
        return {name, members_of(i, surface)};
  lines_.fail(place, fmt::format("there is no surface \"{}\"", field.substr(0, 80)),
              "*SURFACE, NAME=... defines it");
}

/// Elements of lower dimension must be facets of cells: Gmsh, unical and Salome write surfaces so.
void InpAssembler::check_facets()
{
  if (facets_.empty()) return;
  const CellFaces faces = faces_beside(mesh_.cells, mesh_.nodes.size(), facets_);
  Index n_kept = 0;
  for (Element& element : elements_)
  {
    if (element.is_cell || element.number < 0) continue;
    const ElementBlock& facet = facets_[element.number];
    if (faces.contains(key_of(facet.element(0).first(table_of(facet.type.shape).n_corners))))
    {
      if (n_kept < element.number) facets_[n_kept] = std::move(facets_[element.number]);
      element.number = n_kept++;
      continue;
    }
    if (options_.ignores_elements)
    {
      ignore(element);
      continue;
    }
    lines_.fail(element.place,
                fmt::format("element {} ({}) is a {}: it is not {} of a cell", element.label,
                            element.elements->type_name, dim_ == 3 ? "shell" : "truss",
                            dim_ == 3 ? "a face" : "an edge"),
                "only solids, or plane elements alone, are read: model it by solids, or leave it out by "
                "ignore_elements = true");
  }
  facets_.resize(n_kept);
}

std::vector<const ResolvedSet*> InpAssembler::sets_where(bool (*wanted)(const ResolvedSet&)) const
{
  std::vector<const ResolvedSet*> result;
  for (const Instance& instance : instances_)
    for (const ResolvedSet& set : instance.element_sets)
      if (wanted(set)) result.push_back(&set);
  return result;
}

std::vector<CellSet> InpAssembler::members_of(const std::vector<const ResolvedSet*>& sets, bool cells) const
{
  std::vector<CellSet> result;
  result.reserve(sets.size());
  for (const ResolvedSet* set : sets)
  {
    CellSet members{set->name};
    for (const Index e : set->members)
      if (elements_[e].is_cell == cells && elements_[e].number >= 0)
        members.cells.push_back(elements_[e].number);
    if (!members.cells.empty()) result.push_back(std::move(members));
  }
  return result;
}

namespace
{

bool is_section(const ResolvedSet& set)
{
  return set.is_section;
}

bool is_given_set(const ResolvedSet& set)
{
  return set.set->is_from_set_keyword && !set.is_of_surface;
}

bool is_set_of_elements(const ResolvedSet& set)
{
  return !set.set->is_from_set_keyword;
}

}  // namespace

void InpAssembler::add_facets()
{
  std::vector<CellSet> sets = partition_of(members_of(sets_where(is_given_set), false), facets_.size());
  if (sets.empty()) sets = members_of(sets_where(is_set_of_elements), false);
  if (!are_disjoint(sets, facets_.size())) return;
  for (const CellSet& set : sets)
  {
    FacetSet facets{set.name};
    for (const Index f : set.cells)
    {
      FaceNodes nodes{facets_[f].type, {}};
      std::ranges::copy(facets_[f].nodes, nodes.nodes.begin());
      append(facets.facets, nodes, facets_[f].numbers[0]);
    }
    mesh_.facet_sets.push_back(std::move(facets));
  }
}

void InpAssembler::add_regions()
{
  for (const auto wanted : {is_section, is_given_set, is_set_of_elements})
  {
    mesh_.cell_sets = partition_of(members_of(sets_where(wanted), true), n_cells_);
    if (!mesh_.cell_sets.empty()) return;
  }
  bool has_sets = false;
  for (const Instance& instance : instances_)
    for (const ResolvedSet& set : instance.element_sets)
    {
      if (std::ssize(set.members) >= n_cells_)
        if (mesh_.cell_sets = partition_of(members_of({&set}, true), n_cells_); !mesh_.cell_sets.empty())
          return;
      has_sets = has_sets || (!set.is_of_surface && std::ranges::any_of(set.members, [&](Index e)
                                                                        { return elements_[e].is_cell; }));
    }
  if (has_sets) throw_regions_unclear();
}

void InpAssembler::throw_regions_unclear() const
{
  const std::string problem = fault_of_partition(
      members_of(sets_where([](const ResolvedSet& set) { return !set.is_of_surface; }), true), n_cells_,
      [&](Index cell)
      {
        const auto is_it = [&](const Element& element) { return element.is_cell && element.number == cell; };
        return std::ranges::find_if(elements_, is_it)->label;
      });
  throw InputError(mesh_.source,
                   fmt::format("the element sets do not say which region an element is in: {}", problem),
                   "*SOLID SECTION, ELSET=... for sets that have every element once; or take out the others");
}

}  // namespace tribound::mesh
