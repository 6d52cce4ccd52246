#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tribound/case/deck/case_maker.h"

namespace tribound::case_file
{

namespace
{

Node text_node(const std::string& text)
{
  return {text, {}};
}

Node array_of(std::vector<Node> nodes)
{
  return {std::move(nodes), {}};
}

/// " + rho omega^2 (r - (r.a) a)_c", r from the given point of the axis; only the terms that are not 0.
std::string rotation_text(const DeckLoad& load, const Point<3>& a, int c, double density, bool only_last)
{
  constexpr double rounding = 1e-15;
  std::string text;
  for (int j = 0; j < 3; ++j)
  {
    const double factor = (c == j ? 1.0 : 0.0) - a[c] * a[j];
    if (std::abs(factor) > rounding)
      text += fmt::format(" + {}*({} - ({}))", as_factor(load.course.datum(factor * density, only_last)),
                          "xyz"[j], load.data[j]);
  }
  return text;
}

}  // namespace

void CaseMaker::find_regions()
{
  for (const mesh::CellSet& set : assembler_.mesh().cell_sets) cell_groups_.add(set.name, set.cells);
  const auto& model = assembler_.model();
  for (const mesh::InpInstance& instance : model.instances)
    for (const mesh::InpSection& section : model.parts[instance.part].sections)
    {
      const std::string& set = model.parts[instance.part].element_sets.all[section.set].name;
      const std::string name = instance.name.empty() ? set : instance.name + "." + set;
      sections_[name] = section;
      if (std::ranges::count(assembler_.mesh().cell_sets, name, &mesh::CellSet::name) == 0)
        log_.refuse(section.place, section.keyword,
                    fmt::format("the sections do not have every element once; {} has some of another", name),
                    "one section for each element");
      log_.add(section.place, section.keyword, Fate::taken,
               fmt::format("region {} of material {}", name, section.material));
    }
  check_plane(model);
  group_of_load_.assign(deck_.loads.size(), -1);
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
    if (const DeckLoad& load = deck_.loads[i];
        load.kind == DeckLoadKind::gravity || load.kind == DeckLoadKind::rotation)
      group_of_load_[i] = cell_groups_.add(load.target, load.members);
  regions_ = cell_groups_.parts();
  temperatures_ = temperatures(deck_.loads);
  initial_temperatures_ = temperatures(deck_.initial_temperatures);
}

/// A deck that has several plane models is a mistake: a case knows one.
void CaseMaker::check_plane(const mesh::InpModel& model)
{
  if (faces_.dim() == 3) return;
  const auto kind = [](const mesh::InpElements& elements) -> std::string_view
  {
    return elements.type_name.starts_with("CPS")   ? "plane stress"
           : elements.type_name.starts_with("CAX") ? "axisymmetry"
                                                   : "plane strain";
  };
  const mesh::InpElements* first = nullptr;
  for (const mesh::InpPart& part : model.parts)
    for (const mesh::InpElements& elements : part.elements)
    {
      if (elements.family != mesh::InpFamily::plane || elements.places.empty()) continue;
      if (first == nullptr) first = &elements;
      if (kind(elements) != kind(*first))
        log_.refuse(elements.places[0], "ELEMENT",
                    fmt::format("{} beside {}: {} and {} in one deck", elements.type_name, first->type_name,
                                kind(elements), kind(*first)));
    }
}

const DeckMaterial* CaseMaker::material_of(const std::string& region) const
{
  const auto section = sections_.find(region);
  if (section == sections_.end()) return nullptr;
  const auto found =
      std::ranges::find_if(deck_.materials, [&](const DeckMaterial& m)
                           { return mesh::capitals(m.name) == mesh::capitals(section->second.material); });
  return found == deck_.materials.end() ? nullptr : &*found;
}

Node CaseMaker::material(const Groups::Part& region) const
{
  const std::string& set = cell_groups_.name(region.groups[0]);
  const DeckMaterial* material = material_of(set);
  if (material == nullptr || !material->E || !material->nu)
  {
    log_.refuse(sections_.contains(set) ? sections_.at(set).place : mesh::InpPlace{.line = 1},
                "SOLID SECTION", fmt::format("region {} has no elastic material", set),
                "*SOLID SECTION, ELSET=..., MATERIAL=... and *MATERIAL with *ELASTIC");
    return {Node::Table{}, {}};
  }
  Node::Table table;
  put(table, "E", {*material->E, {}});
  put(table, "nu", {*material->nu, {}});
  if (material->alpha) put(table, "alpha", {*material->alpha, {}});
  if (assembler_.is_plane_stress()) put(table, "plane", text_node("stress"));
  return {std::move(table), {}};
}

Node::Table CaseMaker::load(std::size_t region) const
{
  Node::Table table;
  add_body_force(regions_[region], table);
  add_temperature(region, table);
  return table;
}

void CaseMaker::add_body_force(const Groups::Part& region, Node::Table& table) const
{
  const DeckMaterial* material = material_of(cell_groups_.name(region.groups[0]));
  const int dim = faces_.dim();
  std::vector<std::vector<std::pair<double, const Course*>>> uniform(dim);
  std::vector<std::string> varying(dim);
  bool is_given = false;
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
  {
    const DeckLoad& load = deck_.loads[i];
    const bool is_gravity = load.kind == DeckLoadKind::gravity;
    if ((!is_gravity && load.kind != DeckLoadKind::rotation) || !region.is_in(group_of_load_[i])) continue;
    if (material == nullptr || !material->density)
    {
      log_.refuse(load.place, "DLOAD", fmt::format("the material of region {} has no *DENSITY", region.name));
      continue;
    }
    is_given = true;
    const double* axis = load.data.data() + (is_gravity ? 0 : 3);
    const Point<3> a = Point<3>(axis[0], axis[1], axis[2]).normalized();
    for (int c = 0; c < dim; ++c)
      if (is_gravity)
        uniform[c].emplace_back(*material->density * a[c], &load.course);
      else
        varying[c] += rotation_text(load, a, c, *material->density, times_.empty());
  }
  if (!is_given) return;
  std::vector<Node> body;
  for (int c = 0; c < dim; ++c)
  {
    Node node = sum_of(uniform[c], times_.empty());
    body.push_back(varying[c].empty() ? std::move(node) : text_node(as_factor(node) + varying[c]));
  }
  put(table, "body", array_of(std::move(body)));
}

std::vector<CaseMaker::RegionTemperature> CaseMaker::temperatures(const std::vector<DeckLoad>& loads) const
{
  std::vector<const DeckLoad*> of_node(assembler_.mesh().nodes.size(), nullptr);
  for (const DeckLoad& load : loads)
    if (load.kind == DeckLoadKind::temperature)
      for (const Index node : load.members) of_node[node] = &load;
  constexpr std::size_t none = -1;
  std::vector<std::size_t> region_of(faces_.n_cells(), none);
  for (std::size_t r = 0; r < regions_.size(); ++r)
    for (const Index cell : regions_[r].members) region_of[cell] = r;
  std::vector<RegionTemperature> result(regions_.size());
  std::size_t cell = 0;
  for (const mesh::ElementBlock& block : assembler_.mesh().cells)
    for (std::size_t e = 0; e < block.size(); ++e, ++cell)
    {
      if (region_of[cell] == none) continue;
      RegionTemperature& of_region = result[region_of[cell]];
      for (const Index node : block.element(e))
      {
        const DeckLoad* load = of_node[node];
        if (load == nullptr)
          of_region.has_nodes_without = true;
        else if (of_region.load == nullptr)
          of_region.load = load;
        else if (of_region.other == nullptr && !(load->course == of_region.load->course))
          of_region.other = load;
      }
    }
  return result;
}

const Course* CaseMaker::course_of(const RegionTemperature& temperature, const std::string& region) const
{
  const auto& [load, other, has_nodes_without] = temperature;
  if (other != nullptr)
    log_.drop(other->place, "TEMPERATURE",
              fmt::format("region {} has different temperatures at its nodes", region),
              "a formula in load.NAME.temperature of the case");
  else if (load != nullptr && has_nodes_without)
    log_.drop(load->place, "TEMPERATURE",
              fmt::format("not all nodes of region {} have a temperature", region));
  return load == nullptr || other != nullptr || has_nodes_without ? nullptr : &load->course;
}

void CaseMaker::add_temperature(std::size_t region, Node::Table& table) const
{
  const Groups::Part& part = regions_[region];
  const Course* temperature = course_of(temperatures_[region], part.name);
  if (temperature == nullptr) return;
  const DeckMaterial* material = material_of(cell_groups_.name(part.groups[0]));
  if (material == nullptr || !material->alpha) return;  // without expansion nothing depends on it
  put(table, "temperature", temperature->datum(1, times_.empty()));
  if (const Course* initial = course_of(initial_temperatures_[region], part.name))
    put(table, "reference_temperature", initial->datum(1, true));
}

}  // namespace tribound::case_file
