#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/case/deck/case_maker.h"
#include "tribound/mesh/box_tree.h"

namespace tribound::case_file
{

namespace
{

/// The distance of a point from faces; negative behind the nearest of them.
class DistanceFromFaces
{
 public:
  DistanceFromFaces(const DeckFaces& faces, const std::vector<Index>& master)
      : faces_(faces), master_(master), tree_(boxes())
  {
  }

  [[nodiscard]] double operator()(const Point<3>& x) const
  {
    double least = std::numeric_limits<double>::infinity();
    double result = least;
    tree_.traverse([&](const mesh::BoundingBox<3>& box)
                   { return mesh::square_distance(box, x) < least * least; },
                   [&](std::size_t k)
                   {
                     for (const auto& triangle : faces_.triangles(master_[k]))
                       if (const double d = distance(x, triangle); d < least)
                       {
                         least = d;
                         const bool is_behind = (x - triangle[0]).dot(faces_.normal(master_[k])) < 0;
                         result = is_behind ? -d : d;
                       }
                   });
    return result;
  }

 private:
  [[nodiscard]] std::vector<mesh::BoundingBox<3>> boxes() const
  {
    std::vector<mesh::BoundingBox<3>> result(master_.size());
    for (std::size_t k = 0; k < master_.size(); ++k)
      for (const auto& triangle : faces_.triangles(master_[k]))
        for (const Point<3>& corner : triangle) result[k].add(corner);
    return result;
  }

  const DeckFaces& faces_;
  const std::vector<Index>& master_;
  mesh::BoxTree<3> tree_;
};

}  // namespace

std::vector<std::pair<double, const Course*>> CaseMaker::terms(const Groups::Part& part, DeckLoadKind kind,
                                                               int component) const
{
  std::vector<std::pair<double, const Course*>> result;
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
    if (const DeckLoad& load = deck_.loads[i]; load.kind == kind && load.component == component &&
                                               group_of_load_[i] >= 0 && part.is_in(group_of_load_[i]))
      result.emplace_back(1.0, &load.course);
  return result;
}

Node CaseMaker::displacement(const Groups::Part& part, bool& is_given) const
{
  std::vector<Node> components;
  for (int c = 0; c < faces_.dim(); ++c)
  {
    const auto courses = terms(part, DeckLoadKind::displacement, c);
    is_given = is_given || !courses.empty();
    if (std::ranges::any_of(courses, [&](const auto& term) { return !(*term.second == *courses[0].second); }))
    {
      std::string targets;
      mesh::InpPlace place;
      for (std::size_t i = 0; i < deck_.loads.size(); ++i)
        if (const DeckLoad& load = deck_.loads[i]; load.kind == DeckLoadKind::displacement &&
                                                   load.component == c && group_of_load_[i] >= 0 &&
                                                   part.is_in(group_of_load_[i]))
        {
          targets += (targets.empty() ? "" : " and ") + load.target;
          place = load.place;
        }
      log_.refuse(place, "BOUNDARY",
                  fmt::format("component {} of {} is given twice on the same faces, with different values",
                              c + 1, targets));
    }
    components.push_back(courses.empty() ? Node{std::string("free"), {}}
                                         : courses[0].second->datum(1, times_.empty()));
  }
  return {std::move(components), {}};
}

/// Its displacements, pressure and traction; empty if it is a side of a contact, and that alone.
Node::Table CaseMaker::boundary(const Groups::Part& part) const
{
  Node::Table table;
  bool is_held = false;
  Node displacement = this->displacement(part, is_held);
  if (is_held) put(table, "displacement", std::move(displacement));
  if (const auto pressures = terms(part, DeckLoadKind::pressure, 0); !pressures.empty())
    put(table, "pressure", sum_of(pressures, times_.empty()));
  std::vector<Node> traction;
  bool is_pulled = false;
  for (int c = 0; c < faces_.dim(); ++c)
  {
    auto forces = terms(part, DeckLoadKind::force, c);
    std::ranges::copy(terms(part, DeckLoadKind::traction, c), std::back_inserter(forces));
    is_pulled = is_pulled || !forces.empty();
    traction.push_back(sum_of(forces, times_.empty()));
  }
  if (is_pulled) put(table, "traction", {std::move(traction), {}});
  for (std::size_t i = 0; i < group_of_rigid_.size(); ++i)
  {
    if (!part.is_in(group_of_rigid_[i])) continue;
    if (!table.empty())
      log_.refuse(deck_.rigids[i].place, deck_.rigids[i].keyword,
                  fmt::format("{} has other supports or loads", deck_.rigids[i].target),
                  "loads of a rigid body act at its reference node");
    else
      add_rigid(deck_.rigids[i], static_cast<Index>(i), table);
  }
  return table;
}

/// The boundaries that are a side of a contact, without those that have supports or loads.
Node CaseMaker::sides(int group) const
{
  std::vector<Node> names;
  for (std::size_t k = 0; k < boundaries_.size(); ++k)
    if (boundaries_[k].is_in(group) && tables_[k].empty()) names.push_back({boundaries_[k].name, {}});
  if (names.size() == 1) return names[0];
  return {std::move(names), {}};
}

/// Ties of a deck bind what is within their tolerance, by default a fortieth of an element.
double CaseMaker::reach_of_tie(const PairGroups& pair)
{
  const DeckPair& given = *pair.pair;
  if (given.tolerance) return *given.tolerance;
  double edges = 0;
  std::size_t n = 0;
  for (const Index face : face_groups_.members(pair.slave))
    for (const auto& triangle : faces_.triangles(face))
    {
      edges += (triangle[1] - triangle[0]).norm();
      ++n;
    }
  constexpr double share = 0.025;
  const double reach = share * edges / static_cast<double>(n);
  if (given.interaction.empty())
  {
    log_.add(given.place, "TIE", Fate::changed,
             fmt::format("{} and {} are tied where they are within {:.3g}, {} of an edge", given.slave,
                         given.master, reach, share));
    return reach;
  }
  // Surfaces of PRESSURE-OVERCLOSURE=TIED are pulled together whatever is between them.
  constexpr double rounding = 1e-6;
  const DistanceFromFaces distance(faces_, face_groups_.members(pair.master));
  const auto is_apart = [&](Index node)
  { return std::abs(distance(faces_.point(node))) > rounding * reach / share; };
  if (given.clearance || given.adjust ||
      std::ranges::any_of(faces_.nodes_on(face_groups_.members(pair.slave)), is_apart))
    log_.drop(given.place, "CONTACT PAIR",
              fmt::format("{} and {} are TIED with a gap, which the deck closes by force", given.slave,
                          given.master),
              "surfaces that touch");
  return reach;
}

Node::Table CaseMaker::contact(const PairGroups& pair)
{
  const std::string keyword = pair.pair->interaction.empty() ? "TIE" : "CONTACT PAIR";
  Node::Table table;
  for (const auto& [key, group] : {std::pair("slave", pair.slave), std::pair("master", pair.master)})
  {
    Node names = sides(group);
    const auto* several = std::get_if<Node::Array>(&names.value);
    if (several != nullptr && several->empty())
      log_.refuse(pair.pair->place, keyword,
                  fmt::format("all of {} is held or loaded", face_groups_.name(group)));
    put(table, key, std::move(names));
    for (std::size_t k = 0; k < boundaries_.size(); ++k)
      if (boundaries_[k].is_in(group) && !tables_[k].empty())
        log_.drop(pair.pair->place, keyword,
                  fmt::format("a part of {} is held or loaded, and does not touch: {}",
                              face_groups_.name(group), boundaries_[k].name),
                  "contact, supports and loads on separate faces");
  }
  if (pair.interaction == nullptr)
  {
    put(table, "friction", {std::string("tied"), {}});
    put(table, "reach", {reach_of_tie(pair), {}});
    return table;
  }
  const double coefficient = pair.interaction->coefficient;
  put(table, "friction", {std::string(coefficient > 0 ? "coulomb" : "none"), {}});
  if (coefficient > 0) put(table, "coefficient", {coefficient, {}});
  add_gap(pair, table);
  if (find(table, "gap") == nullptr) add_shape(pair, table);
  return table;
}

void CaseMaker::add_shape(const PairGroups& pair, Node::Table& table)
{
  Node::Table shape;
  if (mesh::has_several_orders(assembler_.mesh().cells)) return;  // the .msh has corners alone
  for (const auto& [side, group] : {std::pair("slave", pair.slave), std::pair("master", pair.master)})
  {
    if (std::ranges::none_of(face_groups_.members(group), [&](Index face) { return faces_.is_curved(face); }))
      continue;
    const std::string& name = face_groups_.name(group);
    put(shape, side, {name, {}});
    if (find(shapes_, name) == nullptr)
      put(shapes_, name, {Node::Table{{"mesh", {}, {std::string("order2"), {}}}}, {}});
  }
  if (!shape.empty()) put(table, "shape", {std::move(shape), {}});
}

void CaseMaker::add_gap(const PairGroups& pair, Node::Table& table)
{
  const DeckPair& given = *pair.pair;
  if (given.clearance)
  {
    put(table, "gap", {*given.clearance, {}});
    return;
  }
  if (!given.adjust) return;
  const DistanceFromFaces distance(faces_, face_groups_.members(pair.master));
  const auto is_beyond = [&](Index node)
  { return distance(faces_.point(node)) > *given.adjust * (1 + 1e-9); };
  if (std::ranges::none_of(faces_.nodes_on(face_groups_.members(pair.slave)), is_beyond))
  {
    put(table, "gap", {0.0, {}});
    log_.add(
        given.place, "CONTACT PAIR", Fate::changed,
        fmt::format("ADJUST: the gap between {} and {} is 0; no node is moved", given.slave, given.master));
    return;
  }
  log_.add(
      given.place, "CONTACT PAIR", Fate::changed,
      fmt::format("ADJUST: the gap between {} and {} is that of the meshes, since some nodes are farther "
                  "apart than {}; no node is moved",
                  given.slave, given.master, *given.adjust));
}

/// The force of every contact whose slave is one boundary: along its mean normal; on a body of revolution
/// along the axis, but across it on cylinders.
void CaseMaker::add_quantities(Node::Table& table) const
{
  constexpr double rounding = 1e-10;
  const auto is_across_axis = [&](Index face) { return std::abs(faces_.normal(face)[1]) <= rounding; };
  Node::Array quantities;
  for (const PairGroups& pair : pairs_)
  {
    Node slave = sides(pair.slave);
    if (pair.interaction == nullptr || !std::holds_alternative<std::string>(slave.value)) continue;
    Node::Table quantity;
    put(quantity, "name", {fmt::format("contact force on {}", std::get<std::string>(slave.value)), {}});
    put(quantity, "kind", {std::string("contact_force"), {}});
    put(quantity, "boundary", std::move(slave));
    if (faces_.is_axisymmetric() && !std::ranges::all_of(face_groups_.members(pair.slave), is_across_axis))
      put(quantity, "direction", {Node::Array{{0.0, {}}, {1.0, {}}}, {}});
    quantities.push_back({std::move(quantity), {}});
  }
  if (!quantities.empty()) put(table, "quantity", {std::move(quantities), {}});
}

void CaseMaker::add_probes(Node::Table& table) const
{
  constexpr std::size_t most = 20;
  Node::Table probes;
  for (const DeckPrint& print : deck_.displacements_of_nodes)
  {
    const std::vector<Index> nodes = assembler_.nodes_named(print.target, print.place);
    if (nodes.size() > most)
    {
      log_.add(print.place, "NODE PRINT", Fate::left_out, "displacements of many nodes are in the fields");
      continue;
    }
    for (const Index node : nodes)
    {
      std::vector<Node> point;
      point.reserve(faces_.dim());
      for (int i = 0; i < faces_.dim(); ++i) point.push_back({assembler_.mesh().nodes[node][i], {}});
      const std::string name = fmt::format("node {}", assembler_.mesh().node_numbers[node]);
      if (find(probes, name) == nullptr)
        put(probes, name, {Node::Table{{"point", {}, {std::move(point), {}}}}, {}});
    }
    log_.add(print.place, "NODE PRINT", Fate::taken, "displacements of nodes as probes");
  }
  if (!probes.empty()) put(table, "probe", {std::move(probes), {}});
}

}  // namespace tribound::case_file
