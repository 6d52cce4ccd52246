#include "tribound/mesh/import/inp.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "tribound/mesh/import/face_centres.h"
#include "tribound/mesh/import/inp_assembler.h"

namespace tribound::mesh
{

void InpAssembler::put_together()
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
  check_facets();
  add_regions();
}

ImportedMesh InpAssembler::assemble()
{
  put_together();
  for (std::size_t i = 0; i < instances_.size(); ++i)
    for (const InpSurface& surface : part_of(i).surfaces) add_surface(i, surface);
  add_facets();
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
                     "C3D4, C3D8, C3D10, C3D20 and the like, or CPS, CPE and CAX in the plane");
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
  if (!is_cell && !may_be_facet && options_.ignores_elements)
  {
    for (std::size_t e = 0; e < elements.numbers.size(); ++e)
      ignore(elements_.emplace_back(Element{-1, false, &elements, elements.numbers[e], elements.places[e]}));
    return;
  }
  if (!is_cell && !may_be_facet)
    lines_.fail(
        elements.places[0],
        fmt::format("element {} ({}) is a {}", elements.numbers[0], elements.type_name,
                    elements.family == InpFamily::truss ? "truss" : "shell"),
        "only solids, or plane elements alone, are read: ignore_elements = true leaves the others out; Gmsh "
        "writes curves as trusses: save physical groups of surfaces and volumes alone");
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
  order_face_centres(block, mesh_.nodes);
  mesh_.cells.push_back(std::move(block));
}

void InpAssembler::ignore(Element& element)
{
  element.number = -1;
  const auto [entry, is_new] = ignored_.try_emplace(element.elements->type_name);
  if (is_new) entry->second.first = element.label;
  ++entry->second.n;
}

std::string InpAssembler::ignored() const
{
  std::string text;
  for (const auto& [type, which] : ignored_)
    text += fmt::format("{}{} of type {} (such as {})", text.empty() ? "elements left out: " : ", ", which.n,
                        type, which.first);
  return text;
}

std::string InpAssembler::first_plane_type(std::string_view prefix) const
{
  if (dim_ == 3) return {};
  for (const InpPart& part : model_.parts)
    for (const InpElements& elements : part.elements)
      if (elements.family == InpFamily::plane && elements.type_name.starts_with(prefix))
        return elements.type_name;
  return {};
}

std::string InpAssembler::plane_model() const
{
  std::string text;
  if (is_plane_stress())
    text = fmt::format("the deck has elements of plane stress ({}), a case says so by plane = \"stress\"",
                       first_plane_type(plane_stress_prefix));
  if (is_axisymmetric())
    text +=
        fmt::format("{}the deck has axisymmetric elements ({}), a case says so by model = \"axisymmetric\"",
                    text.empty() ? "" : "; ", first_plane_type(axisymmetric_prefix));
  return text;
}

ImportedMesh read_inp(const std::filesystem::path& file, bool ignores_elements,
                      std::vector<std::string>& notes)
{
  InpAssembler assembler(file, {.ignores_elements = ignores_elements});
  ImportedMesh mesh = assembler.assemble();
  for (const std::string& note : {assembler.ignored(), assembler.plane_model()})
    if (!note.empty()) notes.push_back(fmt::format("{}: {}", file.string(), note));
  return mesh;
}

std::vector<std::filesystem::path> files_of_inp(const std::filesystem::path& file)
{
  InpLines lines(file);
  try
  {
    while (lines.next())
    {
      if (!lines.is_keyword()) continue;
      const InpKeyword keyword = lines.keyword();
      const bool may_include =
          keyword.name == "INCLUDE" || keyword.name == "NODE" || keyword.name == "ELEMENT";
      const auto input = keyword.find("INPUT");
      if (may_include && input) lines.include(*input);
    }
  }
  catch (const InputError&)  // a file is not there
  {
  }
  return lines.files();
}

}  // namespace tribound::mesh
