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

bool is_on_faces(DeckLoadKind kind)
{
  return kind == DeckLoadKind::force || kind == DeckLoadKind::traction || kind == DeckLoadKind::pressure;
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
  if (!deck_.title.empty()) put(document, "title", {deck_.title, {}});
  if (faces_.is_axisymmetric()) put(document, "model", {std::string("axisymmetric"), {}});
  Node::Table materials;
  Node::Table loads;
  for (std::size_t r = 0; r < regions_.size(); ++r)
  {
    put(materials, regions_[r].name, material(regions_[r]));
    if (Node::Table load = this->load(r); !load.empty()) put(loads, regions_[r].name, {std::move(load), {}});
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
  std::vector<std::span<const Index>> held;
  for (const DeckLoad& load : deck_.loads)
    if (load.kind == DeckLoadKind::displacement) held.emplace_back(load.members);
  std::vector<std::vector<Index>> faces_of_held = faces_.with_all_nodes_of(held);
  auto next = faces_of_held.begin();
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
  {
    const DeckLoad& load = deck_.loads[i];
    if (is_on_faces(load.kind)) group_of_load_[i] = face_groups_.add(load.target, load.members);
    if (load.kind != DeckLoadKind::displacement) continue;
    if (std::vector<Index> faces = faces_of_displacement(load, std::move(*next++)); !faces.empty())
      group_of_load_[i] = face_groups_.add(load.target, std::move(faces));
  }
  boundaries_ = face_groups_.parts();
}

std::vector<Index> CaseMaker::faces_of_displacement(const DeckLoad& load, std::vector<Index> faces)
{
  const mesh::ImportedMesh& mesh = assembler_.mesh();
  const std::set<Index> whole = whole_bodies_.within(load.members);
  const std::span<const Index> body = whole_bodies_.bodies();
  std::erase_if(faces, [&](Index face) { return whole.contains(body[faces_.nodes(face).nodes[0]]); });
  const std::vector<Index> nodes_on_faces = faces_.nodes_on(faces);
  const bool is_radial_zero = load.component == 0 && load.course.is_constant() && load.course.last() == 0;
  for (const Index node : load.members)
  {
    if (std::ranges::binary_search(nodes_on_faces, node) || whole.contains(body[node])) continue;
    if (is_radial_zero && faces_.is_on_axis(node)) continue;  // it is there in any case
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

}  // namespace tribound::case_file
