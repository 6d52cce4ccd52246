#include "tribound/mesh/import/inp.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/inp_model.h"

namespace tribound::mesh
{

namespace
{

/// The places of numbers of nodes or elements.
class NumberIndex
{
 public:
  NumberIndex() = default;
  /// The numbers in the order of their places, which begin with `offset`.
  NumberIndex(std::span<const std::int64_t> numbers, std::size_t offset)
  {
    entries_.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      entries_.push_back({numbers[i], static_cast<Index>(offset + i)});
    if (!std::ranges::is_sorted(entries_)) std::ranges::sort(entries_);
  }

  using Entry = std::pair<std::int64_t, Index>;
  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  /// Those from first to last.
  [[nodiscard]] std::span<const Entry> range(std::int64_t first, std::int64_t last) const
  {
    const auto begin = lower_bound(first);
    return last < first ? std::span<const Entry>{} : std::span<const Entry>(begin, lower_bound(last + 1));
  }
  /// -1 if there is none.
  [[nodiscard]] Index find(std::int64_t number) const
  {
    // Mostly numbers have no gaps.
    const auto guess = entries_.empty() ? -1 : number - entries_.front().first;
    if (guess >= 0 && guess < std::ssize(entries_) && entries_[guess].first == number)
      return entries_[guess].second;
    const auto found = lower_bound(number);
    return found == entries_.end() || found->first != number ? -1 : found->second;
  }

 private:
  [[nodiscard]] std::vector<Entry>::const_iterator lower_bound(std::int64_t number) const
  {
    return std::ranges::lower_bound(entries_, number, {}, &Entry::first);
  }

  std::vector<Entry> entries_{};
};

/// A set of an instance, with its members as places in all instances.
struct ResolvedSet
{
  std::string name;  ///< "instance.set"
  const InpSet* set;
  std::vector<Index> members;
  bool is_section = false;
  bool is_of_surface = false;  ///< helps to define a surface
};

class InpAssembler
{
 public:
  explicit InpAssembler(const std::filesystem::path& file) : lines_(file), model_(parse_inp(lines_))
  {
    mesh_.source = {.file = file.string()};
  }

  ImportedMesh assemble();

 private:
  /// What an element has become: a cell or a possible facet, by its number among those.
  struct Element
  {
    Index number;
    bool is_cell;
    const InpElements* elements;
    std::int64_t label;
    InpPlace place;
  };
  struct Instance
  {
    NumberIndex nodes{};
    NumberIndex elements{};
    std::vector<ResolvedSet> node_sets{};
    std::vector<ResolvedSet> element_sets{};
  };

  [[nodiscard]] const InpPart& part_of(std::size_t i) const { return model_.parts[model_.instances[i].part]; }
  [[nodiscard]] std::string full_name(std::size_t i, const std::string& name) const
  {
    return i == 0 ? name : model_.instances[i].name + "." + name;
  }
  void check_instances() const;
  void find_dimension();
  void add_nodes(std::size_t i);
  void add_elements(std::size_t i);
  void add_block(std::size_t i, const InpElements& elements);
  void order_centres(ElementBlock& block) const;
  void resolve(std::size_t i, InpSets InpPart::*sets, std::vector<ResolvedSet> Instance::*resolved,
               NumberIndex Instance::*index);
  void add_members(const InpMembers& members, std::size_t i, const InpPlace& place,
                   std::vector<Index>& places, std::vector<ResolvedSet> Instance::*resolved,
                   NumberIndex Instance::*index);
  void mark_sets(std::size_t i);
  void add_surface(std::size_t i, const InpSurface& surface);
  [[nodiscard]] FaceNodes face_of(const Element& element, int face, const InpPlace& place) const;
  void check_facets() const;
  void add_facets();
  void add_regions();
  [[nodiscard]] std::vector<const ResolvedSet*> sets_where(bool (*wanted)(const ResolvedSet&)) const;
  /// Their elements that are cells, or that are none, by number; nothing where one is in two sets.
  [[nodiscard]] std::vector<CellSet> disjoint(const std::vector<const ResolvedSet*>& sets,
                                              bool of_cells) const;
  /// The same; nothing unless every element is in a set.
  [[nodiscard]] std::vector<CellSet> partition(const std::vector<const ResolvedSet*>& sets,
                                               bool of_cells) const;
  [[noreturn]] void throw_regions_unclear() const;

  InpLines lines_;
  InpModel model_;
  ImportedMesh mesh_{};
  int dim_ = 3;
  std::vector<Instance> instances_{};
  std::vector<Element> elements_{};     ///< of all instances
  std::vector<ElementBlock> facets_{};  ///< one element each that is no cell
  std::vector<Index> first_cell_{};     ///< of each block of cells
  Index n_cells_ = 0;
  std::size_t n_members_ = 0;  ///< of all sets so far
};

ImportedMesh InpAssembler::assemble()
{
  check_instances();
  find_dimension();
  instances_.resize(model_.instances.size());
  for (std::size_t i = 0; i < instances_.size(); ++i)
  {
    add_nodes(i);
    add_elements(i);
  }
  for (std::size_t k = 0; k < instances_.size(); ++k)
  {
    const std::size_t i = (k + 1) % instances_.size();  // the assembly last: its sets name those of instances
    resolve(i, &InpPart::node_sets, &Instance::node_sets, &Instance::nodes);
    resolve(i, &InpPart::element_sets, &Instance::element_sets, &Instance::elements);
    mark_sets(i);
  }
  for (std::size_t i = 0; i < instances_.size(); ++i)
    for (const InpSurface& surface : part_of(i).surfaces) add_surface(i, surface);
  check_facets();
  add_facets();
  add_regions();
  for (Instance& instance : instances_)
    for (ResolvedSet& set : instance.node_sets)
      if (!set.members.empty()) mesh_.node_sets.push_back({set.name, std::move(set.members)});
  return std::move(mesh_);
}

void InpAssembler::check_instances() const
{
  for (std::size_t p = 1; p < model_.parts.size(); ++p)
    if (std::ranges::count(model_.instances, static_cast<int>(p), &InpInstance::part) == 0)
      lines_.fail(model_.parts[p].place, fmt::format("part \"{}\" has no instance", model_.parts[p].name),
                  "*INSTANCE, NAME=..., PART=... in the *ASSEMBLY; or take out the part");
}

void InpAssembler::find_dimension()
{
  const auto has = [&](InpFamily family)
  {
    return std::ranges::any_of(
        model_.parts, [&](const InpPart& part)
        { return std::ranges::count(part.elements, family, &InpElements::family) > 0; });
  };
  dim_ = has(InpFamily::solid) ? 3 : 2;
  if (dim_ == 2 && !has(InpFamily::plane))
    throw InputError(mesh_.source, "the mesh has neither plane elements nor solids",
                     "C3D4, C3D8, C3D10, C3D20 and the like, or CPS and CPE in the plane");
}

void InpAssembler::add_nodes(std::size_t i)
{
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  const InpPart& part = part_of(i);
  const InpInstance& instance = model_.instances[i];
  if (mesh_.nodes.size() + part.nodes.size() > most)
    throw InputError(mesh_.source, "there are too many nodes for 32-bit numbers");
  instances_[i].nodes = NumberIndex(part.node_numbers, mesh_.nodes.size());
  const auto entries = instances_[i].nodes.entries();
  for (std::size_t k = 1; k < entries.size(); ++k)
    if (entries[k - 1].first == entries[k].first)
    {
      const std::size_t second = entries[k].second - mesh_.nodes.size();
      lines_.fail(part.node_places[second], fmt::format("node {} is defined twice", entries[k].first),
                  "give the nodes of separate meshes different numbers, or make them parts");
    }
  for (const Point<3>& x : part.nodes)
    mesh_.nodes.push_back(i == 0 ? x : Point<3>(instance.rotation * x + instance.shift));
  mesh_.node_numbers.insert(mesh_.node_numbers.end(), part.node_numbers.begin(), part.node_numbers.end());
}

void InpAssembler::add_elements(std::size_t i)
{
  const std::size_t first = elements_.size();
  for (const InpElements& elements : part_of(i).elements) add_block(i, elements);
  std::vector<std::int64_t> numbers;
  numbers.reserve(elements_.size() - first);
  for (std::size_t e = first; e < elements_.size(); ++e) numbers.push_back(elements_[e].label);
  instances_[i].elements = NumberIndex(numbers, first);
  const auto entries = instances_[i].elements.entries();
  for (std::size_t k = 1; k < entries.size(); ++k)
    if (entries[k - 1].first == entries[k].first)
      lines_.fail(elements_[entries[k].second].place,
                  fmt::format("element {} is defined twice", entries[k].first),
                  "give the elements different numbers");
}

void InpAssembler::add_block(std::size_t i, const InpElements& elements)
{
  const bool is_cell = elements.family == (dim_ == 3 ? InpFamily::solid : InpFamily::plane);
  const bool may_be_facet = dim_ == 3
                                ? elements.family == InpFamily::plane || elements.family == InpFamily::shell
                                : elements.family == InpFamily::truss;
  if (!is_cell && !may_be_facet)
    lines_.fail(
        elements.places[0],
        fmt::format("element {} ({}) is a {}", elements.numbers[0], elements.type_name,
                    elements.family == InpFamily::truss ? "truss" : "shell"),
        "only solids, or plane elements alone, are read; Gmsh writes curves as trusses: save physical "
        "groups of surfaces and volumes alone");
  ElementBlock block{elements.type, {}, elements.numbers};
  block.nodes.reserve(elements.nodes.size());
  const auto stride = static_cast<std::size_t>(elements.type.n_nodes);
  for (std::size_t k = 0; k < elements.nodes.size(); ++k)
  {
    const Index node = instances_[i].nodes.find(elements.nodes[k]);
    if (node < 0)
      lines_.fail(elements.places[k / stride],
                  fmt::format("node {} of element {} is not defined", elements.nodes[k],
                              elements.numbers[k / stride]),
                  "is the deck complete? An *INCLUDE may be missing");
    block.nodes.push_back(node);
  }
  if (is_cell) first_cell_.push_back(n_cells_);
  for (std::size_t e = 0; e < elements.numbers.size(); ++e)
  {
    const Index number = is_cell ? n_cells_++ : static_cast<Index>(facets_.size());
    elements_.push_back({number, is_cell, &elements, elements.numbers[e], elements.places[e]});
    if (is_cell) continue;
    const auto nodes = block.element(e);
    facets_.push_back({elements.type, {nodes.begin(), nodes.end()}, {elements.numbers[e]}});
  }
  if (!is_cell) return;
  order_centres(block);
  mesh_.cells.push_back(std::move(block));
}

/// Decks differ in the order of the nodes after those of the edges: the centre of a face is the one nearest
/// to the middle of its corners.
void InpAssembler::order_centres(ElementBlock& block) const
{
  const ShapeTable& table = table_of(block.type.shape);
  const int first = table.n_corners + table.n_edges;
  if (table.dim < 3 || block.type.n_nodes <= first + 1) return;
  for (std::size_t e = 0; e < block.size(); ++e)
  {
    const auto nodes = std::span(block.nodes).subspan(e * block.type.n_nodes, block.type.n_nodes);
    auto rest = nodes.subspan(first);
    for (int f = 0; f < table.n_faces; ++f)
    {
      if (table.faces[f].n < 4) continue;
      Point<3> middle = Point<3>::Zero();
      for (const int c : table.faces[f].span()) middle += mesh_.nodes[nodes[c]] / 4;
      const auto nearest = std::ranges::min_element(
          rest, {}, [&](Index node) { return (mesh_.nodes[node] - middle).squaredNorm(); });
      std::iter_swap(rest.begin(), nearest);
      rest = rest.subspan(1);
    }
  }
}

void InpAssembler::add_members(const InpMembers& members, std::size_t i, const InpPlace& place,
                               std::vector<Index>& places, std::vector<ResolvedSet> Instance::*resolved,
                               NumberIndex Instance::*index)
{
  constexpr std::size_t most = 500'000'000;
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
    if (!std::ranges::is_sorted(places)) std::ranges::sort(places);
    places.erase(std::ranges::unique(places).begin(), places.end());
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
    else if (!set.members.empty())
      lines_.fail(section.place,
                  fmt::format("element {} is in a *{}", elements_[set.members[0]].label, section.keyword),
                  "shells, membranes and beams have no counterpart: model them by solids, or leave them out");
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

void InpAssembler::add_surface(std::size_t i, const InpSurface& surface)
{
  const std::string name = full_name(i, surface.name);
  FacetSet facets{name};
  NodeSet nodes{name, {}, true};
  std::vector<Index> places;
  for (const InpSurfacePart& part : surface.parts)
  {
    if (surface.is_of_nodes)
    {
      add_members(part.elements, i, part.place, nodes.nodes, &Instance::node_sets, &Instance::nodes);
      continue;
    }
    places.clear();
    add_members(part.elements, i, part.place, places, &Instance::element_sets, &Instance::elements);
    for (const Index e : places)
      append(facets.facets, face_of(elements_[e], part.face, part.place), elements_[e].label);
  }
  if (facets.facets.empty() && nodes.nodes.empty())
    lines_.fail(surface.place, fmt::format("surface \"{}\" is empty", surface.name));
  if (surface.is_of_nodes)
  {
    std::ranges::sort(nodes.nodes);
    nodes.nodes.erase(std::ranges::unique(nodes.nodes).begin(), nodes.nodes.end());
    mesh_.node_sets.push_back(std::move(nodes));
  }
  else
    mesh_.facet_sets.push_back(std::move(facets));
}

/// Elements of lower dimension must be facets of cells: Gmsh, unical and Salome write surfaces so.
void InpAssembler::check_facets() const
{
  if (facets_.empty()) return;
  std::vector<char> is_marked(mesh_.nodes.size(), 0);
  for (const ElementBlock& facet : facets_)
    for (const Index node : facet.nodes) is_marked[node] = 1;
  const CellFaces faces(mesh_.cells, is_marked);
  for (const Element& element : elements_)
  {
    if (element.is_cell) continue;
    const ElementBlock& facet = facets_[element.number];
    if (faces.contains(key_of(facet.element(0).first(table_of(facet.type.shape).n_corners)))) continue;
    lines_.fail(element.place,
                fmt::format("element {} ({}) is a {}: it is not {} of a cell", element.label,
                            element.elements->type_name, dim_ == 3 ? "shell" : "truss",
                            dim_ == 3 ? "a face" : "an edge"),
                "only solids, or plane elements alone, are read: model it by solids, or leave it out");
  }
}

std::vector<const ResolvedSet*> InpAssembler::sets_where(bool (*wanted)(const ResolvedSet&)) const
{
  std::vector<const ResolvedSet*> result;
  for (const Instance& instance : instances_)
    for (const ResolvedSet& set : instance.element_sets)
      if (wanted(set)) result.push_back(&set);
  return result;
}

std::vector<CellSet> InpAssembler::disjoint(const std::vector<const ResolvedSet*>& sets, bool of_cells) const
{
  std::vector<char> is_taken(of_cells ? n_cells_ : facets_.size(), 0);
  std::vector<CellSet> result;
  for (const ResolvedSet* set : sets)
  {
    CellSet cells{set->name};
    for (const Index e : set->members)
    {
      if (elements_[e].is_cell != of_cells) continue;
      if (is_taken[elements_[e].number]++ != 0) return {};
      cells.cells.push_back(elements_[e].number);
    }
    if (!cells.cells.empty()) result.push_back(std::move(cells));
  }
  return result;
}

std::vector<CellSet> InpAssembler::partition(const std::vector<const ResolvedSet*>& sets, bool of_cells) const
{
  std::vector<CellSet> result = disjoint(sets, of_cells);
  std::size_t n = 0;
  for (const CellSet& set : result) n += set.cells.size();
  return n == (of_cells ? n_cells_ : facets_.size()) ? result : std::vector<CellSet>{};
}

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

void InpAssembler::add_facets()
{
  std::vector<CellSet> sets = partition(sets_where(is_given_set), false);
  if (sets.empty()) sets = disjoint(sets_where(is_set_of_elements), false);
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
    if (mesh_.cell_sets = partition(sets_where(wanted), true); !mesh_.cell_sets.empty()) return;
  bool has_sets = false;
  for (const Instance& instance : instances_)
    for (const ResolvedSet& set : instance.element_sets)
    {
      if (std::ssize(set.members) >= n_cells_)
        if (mesh_.cell_sets = partition({&set}, true); !mesh_.cell_sets.empty()) return;
      has_sets = has_sets || (!set.is_of_surface && std::ranges::any_of(set.members, [&](Index e)
                                                                        { return elements_[e].is_cell; }));
    }
  if (has_sets) throw_regions_unclear();
}

void InpAssembler::throw_regions_unclear() const
{
  std::vector<const ResolvedSet*> set_of(elements_.size(), nullptr);
  std::string problem;
  for (const ResolvedSet* set : sets_where([](const ResolvedSet& s) { return !s.is_of_surface; }))
    for (const Index e : set->members)
    {
      if (set_of[e] && problem.empty())
        problem = fmt::format("element {} is in \"{}\" and in \"{}\"", elements_[e].label, set_of[e]->name,
                              set->name);
      set_of[e] = set;
    }
  const auto none = std::ranges::find(set_of, nullptr);
  if (none != set_of.end() && problem.empty())
    problem = fmt::format("element {} is in no set", elements_[none - set_of.begin()].label);
  throw InputError(mesh_.source,
                   fmt::format("the element sets do not say which region an element is in: {}", problem),
                   "*SOLID SECTION, ELSET=... for sets that have every element once; or take out the others");
}

}  // namespace

ImportedMesh read_inp(const std::filesystem::path& file)
{
  return InpAssembler(file).assemble();
}

}  // namespace tribound::mesh
