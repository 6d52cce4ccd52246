#include "tribound/case/deck/case_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/base/sorted.h"
#include "tribound/case/deck/deck_reader.h"

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

bool is_on_faces(DeckLoadKind kind)
{
  return kind == DeckLoadKind::force || kind == DeckLoadKind::traction || kind == DeckLoadKind::pressure;
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

Node::Table CaseMaker::make()
{
  find_regions();
  find_boundaries();
  find_history();
  tables_.reserve(boundaries_.size());
  for (const Groups::Part& part : boundaries_) tables_.push_back(boundary(part));
  Node::Table document;
  if (!deck_.title.empty()) put(document, "title", text_node(deck_.title));
  Node::Table materials;
  Node::Table loads;
  for (const Groups::Part& region : regions_)
  {
    put(materials, region.name, material(region));
    if (Node::Table load = this->load(region); !load.empty()) put(loads, region.name, {std::move(load), {}});
  }
  put(document, "material", {std::move(materials), {}});
  if (!loads.empty()) put(document, "load", {std::move(loads), {}});

  Node::Array contacts;
  for (const PairGroups& pair : pairs_) contacts.push_back({contact(pair), {}});
  Node::Table tables;
  for (std::size_t k = 0; k < boundaries_.size(); ++k)
    if (!tables_[k].empty()) put(tables, boundaries_[k].name, {tables_[k], {}});
  if (!tables.empty()) put(document, "boundary", {std::move(tables), {}});
  if (!contacts.empty()) put(document, "contact", {std::move(contacts), {}});
  if (!shapes_.empty()) put(document, "shape", {std::move(shapes_), {}});
  if (!times_.empty())
  {
    Node::Array steps;
    for (const double t : times_) steps.push_back({t, {}});
    put(document, "history", {Node::Table{{"steps", {}, {std::move(steps), {}}}}, {}});
  }
  add_quantities(document);
  add_probes(document);
  return document;
}

mesh::ImportedMesh CaseMaker::mesh() const
{
  mesh::ImportedMesh result = assembler_.mesh();
  result.cell_sets.clear();
  result.facet_sets.clear();
  result.node_sets.clear();
  for (const Groups::Part& region : regions_) result.cell_sets.push_back({region.name, region.members});
  for (const Groups::Part& part : boundaries_)
  {
    mesh::FacetSet set{part.name};
    for (const Index face : part.members) mesh::append(set.facets, faces_.nodes(face), faces_.label(face));
    result.facet_sets.push_back(std::move(set));
  }
  return result;
}

/// Increments count where there is friction; else the ends of the steps and the kinks of the loads.
void CaseMaker::find_history()
{
  constexpr double most_increments = 100;
  const bool has_friction =
      std::ranges::any_of(pairs_, [](const PairGroups& pair)
                          { return pair.interaction != nullptr && pair.interaction->coefficient > 0; });
  for (const DeckStep& step : deck_.steps)
  {
    const double period = step.end - step.begin;
    const double n =
        has_friction ? std::clamp(std::ceil(period / step.increment - 1e-9), 1.0, most_increments) : 1.0;
    if (has_friction && period > most_increments * step.increment * (1 + 1e-9))
      log_.add(step.place, "STATIC", Fate::changed,
               fmt::format("{} increments in place of {:.0f}", most_increments, period / step.increment));
    for (int k = 1; k <= static_cast<int>(n); ++k) times_.push_back(step.begin + period * k / n);
  }
  const double end = deck_.steps.back().end;
  for (const DeckLoad& load : deck_.loads)
    for (const Course::Point& p : load.course.points())
      if (p.t > 0 && p.t < end) times_.push_back(p.t);
  sort_and_unite(times_);
  if (times_.size() == 1) times_.clear();
}

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
}

/// A case knows one plane model for each region; a deck that has both is a mistake.
void CaseMaker::check_plane(const mesh::InpModel& model)
{
  if (faces_.dim() == 3) return;
  const mesh::InpElements* first = nullptr;
  for (const mesh::InpPart& part : model.parts)
    for (const mesh::InpElements& elements : part.elements)
    {
      if (elements.family != mesh::InpFamily::plane || elements.places.empty()) continue;
      if (first == nullptr) first = &elements;
      if (elements.type_name.starts_with("CPS") != first->type_name.starts_with("CPS"))
        log_.refuse(elements.places[0], "ELEMENT",
                    fmt::format("{} beside {}: plane stress and plane strain in one deck", elements.type_name,
                                first->type_name));
    }
}

void CaseMaker::find_boundaries()
{
  for (const DeckPair& pair : deck_.pairs)
  {
    const DeckInteraction* interaction = nullptr;
    for (const DeckInteraction& i : deck_.interactions)
      if (!pair.interaction.empty() && mesh::capitals(i.name) == mesh::capitals(pair.interaction))
        interaction = &i;
    if (!pair.interaction.empty() && interaction == nullptr)
      assembler_.lines().fail(pair.place,
                              fmt::format("there is no *SURFACE INTERACTION \"{}\"", pair.interaction));
    if (interaction != nullptr && interaction->is_tied) interaction = nullptr;
    const auto side = [&](const std::string& name)
    { return face_groups_.add(name, faces_of_surface(assembler_, faces_, name, pair.place)); };
    const int slave = side(pair.slave);
    pairs_.push_back({&pair, interaction, slave, side(pair.master)});
  }
  for (const DeckRigid& rigid : deck_.rigids)
    group_of_rigid_.push_back(face_groups_.add(rigid.target, rigid.faces));
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
  {
    const DeckLoad& load = deck_.loads[i];
    if (is_on_faces(load.kind)) group_of_load_[i] = face_groups_.add(load.target, load.members);
    if (load.kind != DeckLoadKind::displacement) continue;
    if (std::vector<Index> faces = faces_of_displacement(load); !faces.empty())
      group_of_load_[i] = face_groups_.add(load.target, std::move(faces));
  }
  boundaries_ = face_groups_.parts();
}

std::vector<Index> CaseMaker::faces_of_displacement(const DeckLoad& load)
{
  const mesh::ImportedMesh& mesh = assembler_.mesh();
  const std::set<Index> whole = whole_bodies_.within(load.members);
  const std::span<const Index> body = whole_bodies_.bodies();
  std::vector<Index> faces = faces_.with_all_nodes(load.members);
  std::erase_if(faces, [&](Index face) { return whole.contains(body[faces_.nodes(face).nodes[0]]); });
  std::vector<char> is_on_face(body.size(), 0);
  for (const Index node : faces_.nodes_on(faces)) is_on_face[node] = 1;
  for (const Index node : load.members)
  {
    if (is_on_face[node] != 0 || whole.contains(body[node])) continue;
    log_.drop(
        load.place, "BOUNDARY",
        fmt::format(
            "{}: component {} of node {}, {}", load.target, load.component + 1, mesh.node_numbers[node],
            body[node] < 0 ? "which belongs to no solid" : "which lies on no face that is held as a whole"),
        "a case holds faces: hold all nodes of some; against rigid motions alone a plane of symmetry, or "
        "a soft spring (boundary.NAME.spring), does");
    break;
  }
  add_faces_across(load, whole, faces);
  return faces;
}

void CaseMaker::add_faces_across(const DeckLoad& load, const std::set<Index>& whole,
                                 std::vector<Index>& faces)
{
  if (whole.empty()) return;
  bool is_prism = load.course.is_constant() && load.course.last() == 0;
  for (std::size_t f = 0; f < faces_.size(); ++f)
  {
    const auto face = static_cast<Index>(f);
    if (!whole.contains(whole_bodies_.bodies()[faces_.nodes(face).nodes[0]])) continue;
    constexpr double tolerance = 1e-6;
    const double along = std::abs(faces_.normal(face)[load.component]);
    if (along > 1 - tolerance) faces.push_back(face);
    is_prism = is_prism && (along > 1 - tolerance || along < tolerance);
  }
  sort_and_unite(faces);
  is_prism = is_prism && are_corners_on(faces, whole);
  const std::string what =
      fmt::format("{}: component {} of all nodes of a body", load.target, load.component + 1);
  if (is_prism)
    log_.add(load.place, "BOUNDARY", Fate::changed,
             what + " is held on the faces across it alone: the same where nothing varies along it");
  else
    log_.drop(load.place, "BOUNDARY", what + " is given, inside, too", "a case holds faces");
}

bool CaseMaker::are_corners_on(const std::vector<Index>& faces, const std::set<Index>& whole) const
{
  std::vector<char> is_on(whole_bodies_.bodies().size(), 0);
  for (const Index node : faces_.nodes_on(faces)) is_on[node] = 1;
  for (const mesh::ElementBlock& block : assembler_.mesh().cells)
    for (std::size_t e = 0; e < block.size(); ++e)
      for (const Index node : block.element(e).first(mesh::table_of(block.type.shape).n_corners))
        if (is_on[node] == 0 && whole.contains(whole_bodies_.bodies()[node])) return false;
  return true;
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
  if (!assembler_.plane_stress().empty()) put(table, "plane", text_node("stress"));
  return {std::move(table), {}};
}

Node::Table CaseMaker::load(const Groups::Part& region) const
{
  Node::Table table;
  add_body_force(region, table);
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

const Course* CaseMaker::temperature_of(const Groups::Part& region, const std::vector<DeckLoad>& loads) const
{
  std::vector<const DeckLoad*> of_node(assembler_.mesh().nodes.size(), nullptr);
  for (const DeckLoad& load : loads)
    if (load.kind == DeckLoadKind::temperature)
      for (const Index node : load.members) of_node[node] = &load;
  const DeckLoad* found = nullptr;
  bool has_none = false;
  std::vector<char> is_in(faces_.n_cells(), 0);
  for (const Index cell : region.members) is_in[cell] = 1;
  std::size_t cell = 0;
  for (const mesh::ElementBlock& block : assembler_.mesh().cells)
    for (std::size_t e = 0; e < block.size(); ++e, ++cell)
    {
      if (is_in[cell] == 0) continue;
      for (const Index node : block.element(e))
      {
        const DeckLoad* load = of_node[node];
        has_none = has_none || load == nullptr;
        if (load == nullptr) continue;
        if (found != nullptr && !(found->course == load->course))
        {
          log_.drop(load->place, "TEMPERATURE",
                    fmt::format("region {} has different temperatures at its nodes", region.name),
                    "a formula in load.NAME.temperature of the case");
          return nullptr;
        }
        found = load;
      }
    }
  if (found != nullptr && has_none)
    log_.drop(found->place, "TEMPERATURE",
              fmt::format("not all nodes of region {} have a temperature", region.name));
  return found == nullptr || has_none ? nullptr : &found->course;
}

void CaseMaker::add_temperature(const Groups::Part& region, Node::Table& table) const
{
  const Course* temperature = temperature_of(region, deck_.loads);
  if (temperature == nullptr) return;
  const DeckMaterial* material = material_of(cell_groups_.name(region.groups[0]));
  if (material == nullptr || !material->alpha) return;  // without expansion nothing depends on it
  put(table, "temperature", temperature->datum(1, times_.empty()));
  if (const Course* initial = temperature_of(region, deck_.initial_temperatures))
    put(table, "reference_temperature", initial->datum(1, true));
}

}  // namespace tribound::case_file
