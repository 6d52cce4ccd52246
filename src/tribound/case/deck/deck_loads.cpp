#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "tribound/base/sorted.h"
#include "tribound/case/deck/deck_reader.h"
#include "tribound/case/deck/nodal_forces.h"

namespace tribound::case_file
{

std::vector<Index> DeckReader::outer(const std::vector<mesh::FaceNodes>& faces,
                                     const mesh::InpPlace& place) const
{
  std::vector<Index> result;
  for (const mesh::FaceNodes& face : faces)
  {
    result.push_back(faces_.find(face));
    if (result.back() < 0)
      assembler_.lines().fail(place, "a face lies inside the mesh, between two elements",
                              "loads and contact act on outer faces");
  }
  sort_and_unite(result);
  return result;
}

std::vector<Index> faces_of_surface(mesh::InpAssembler& assembler, const DeckFaces& faces,
                                    std::string_view name, const mesh::InpPlace& place)
{
  const auto [_, members] = assembler.surface_named(name, place);
  std::vector<Index> result;
  if (!members.nodes.empty())
  {
    result = faces.with_all_nodes(members.nodes);
    if (result.empty())
      assembler.lines().fail(place,
                             fmt::format("\"{}\" has no facet: no outer facet has all its nodes in it", name),
                             "a surface of nodes needs all nodes of its faces");
    return result;
  }
  for (std::size_t f = 0; f < members.faces.size(); ++f)
  {
    result.push_back(faces.find(members.faces[f]));
    if (result.back() < 0)
      assembler.lines().fail(place,
                             fmt::format("surface \"{}\": a face of element {} lies inside the mesh, between "
                                         "two elements",
                                         name, members.labels[f]),
                             "loads and contact act on outer faces");
  }
  sort_and_unite(result);
  return result;
}

void DeckReader::read_nodal_forces(const Block& block)
{
  note_new(block, std::array{DeckLoadKind::force, DeckLoadKind::rigid_force});
  struct Forces
  {
    const Line* line = nullptr;
    std::map<Index, Point<3>> of_node{};
    std::array<bool, 3> is_named{};
  };
  std::map<std::string, Forces> sets;  ///< nodes given one by one under ""
  for (const Line& line : block.lines)
  {
    if (line.fields.size() < 2)
      assembler_.lines().fail(line.place, "a line of *CLOAD: set or node, component, force");
    const std::vector<Index> nodes = assembler_.nodes_named(line.fields[0], line.place);
    if (apply_to_rigid(block, line, nodes)) continue;
    const bool is_single = mesh::integer_of(line.fields[0]).has_value();
    const std::optional<std::int64_t> component = mesh::integer_of(line.fields[1]);
    if (!component || *component < 1 || *component > faces_.dim())
      assembler_.lines().fail(line.place, fmt::format("\"{}\" is no component of a force", line.fields[1]),
                              faces_.dim() == 3 ? "1, 2 or 3; solids take no moments" : "1 or 2");
    Forces& forces = sets[is_single ? "" : mesh::capitals(line.fields[0])];
    if (forces.line == nullptr) forces.line = &line;
    forces.is_named[*component - 1] = true;
    for (const Index node : nodes)
      forces.of_node.try_emplace(node, Point<3>::Zero()).first->second[*component - 1] += number(line, 2);
  }
  for (const auto& [name, forces] : sets)
    spread_forces(block, *forces.line, name.empty() ? line_name(*forces.line) : forces.line->fields[0],
                  forces.of_node, forces.is_named);
}

void DeckReader::spread_forces(const Block& block, const Line& line, const std::string& target,
                               const std::map<Index, Point<3>>& forces, const std::array<bool, 3>& is_named)
{
  const SpreadForces spread_out = spread(faces_, forces);
  if (!spread_out.lone_nodes.empty())
    log_.drop(line.place, "CLOAD",
              fmt::format("forces at single nodes, such as node {}: the displacement under them is infinite",
                          assembler_.mesh().node_numbers[spread_out.lone_nodes[0]]),
              "spread the force over the faces that carry it (*DSLOAD)");
  for (const SpreadForce& part : spread_out.parts)
  {
    const Point<3> traction = part.traction / thickness_;
    const std::string text = fmt::format("{}: traction ({:.6g}, {:.6g}, {:.6g}) on an area of {:.6g}", target,
                                         traction[0], traction[1], traction[2], part.area * thickness_);
    const std::string spread_text = text + ": the sum of the forces spread evenly, not as they were given";
    if (part.is_exact)
      log_.add(line.place, "CLOAD", Fate::taken, text);
    else if (part.keeps_resultant)
      log_.add(line.place, "CLOAD", Fate::changed, spread_text);
    else
      log_.drop(line.place, "CLOAD", spread_text + "; their moment, or what cancels, is lost",
                "a traction that varies, or a boundary that is rigid (boundary.NAME.rigid)");
    for (int c = 0; c < faces_.dim(); ++c)
      if (is_named[c])
        apply(load_on(DeckLoadKind::force, block, line.place, target, part.faces, c), traction[c], block);
  }
}

namespace
{

constexpr std::array distributed_loads = {DeckLoadKind::pressure, DeckLoadKind::traction,
                                          DeckLoadKind::gravity, DeckLoadKind::rotation};

}  // namespace

void DeckReader::read_element_loads(const Block& block)
{
  note_new(block, distributed_loads);
  // Elements given one by one are taken together where the load agrees.
  std::map<std::string, std::pair<const Line*, std::vector<mesh::FaceNodes>>> singles;
  const auto press =
      [&](const Line& line, const std::string& target, const std::vector<mesh::FaceNodes>& faces)
  {
    std::vector<Index> members = outer(faces, line.place);
    if (members.size() != faces.size())
      log_.refuse(line.place, "DLOAD", "a face of an element has the load twice", "one line with the sum");
    apply(load_on(DeckLoadKind::pressure, block, line.place, target, std::move(members)), number(line, 2),
          block);
    log_.add(line.place, "DLOAD", Fate::taken, fmt::format("{}: pressure", target));
  };
  for (const Line& line : block.lines)
  {
    const std::string label = mesh::capitals(field(line, 1));
    if (label == "GRAV" || label == "CENTRIF")
    {
      read_acceleration(block, line, label);
      continue;
    }
    const bool is_pressure = label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6';
    if (!is_pressure)
    {
      log_.drop(line.place, "DLOAD", fmt::format("the load \"{}\" cannot be imported", field(line, 1)),
                "P1 to P6, GRAV and CENTRIF can");
      continue;
    }
    std::vector<mesh::FaceNodes> faces;
    for (const Index e : assembler_.elements_named(line.fields[0], line.place))
      faces.push_back(assembler_.face_of(assembler_.elements()[e], label[1] - '1', line.place));
    if (!mesh::integer_of(line.fields[0]))
    {
      press(line, fmt::format("{}.{}", line.fields[0], label), faces);
      continue;
    }
    auto& [first, all] = singles[field(line, 2)];
    if (first == nullptr) first = &line;
    all.insert(all.end(), faces.begin(), faces.end());
  }
  for (const auto& [_, single] : singles) press(*single.first, line_name(*single.first), single.second);
}

/// Whether an acceleration leaves plane decks in their plane, and bodies of revolution what they are.
bool DeckReader::can_act(bool is_gravity, std::span<const double> data) const
{
  const auto is_along = [&](std::size_t first, int axis)
  {
    for (int i = 0; i < 3; ++i)
      if (i != axis && data[first + i] != 0) return false;
    return true;
  };
  constexpr int y = 1;
  if (faces_.is_axisymmetric()) return is_gravity ? is_along(0, y) : is_along(0, y) && is_along(3, y);
  if (faces_.dim() == 3) return true;
  return is_gravity ? data[2] == 0 : is_along(3, 2);
}

void DeckReader::read_acceleration(const Block& block, const Line& line, const std::string& label)
{
  std::vector<Index> cells;
  for (const Index e : assembler_.elements_named(line.fields[0], line.place))
    if (const auto& element = assembler_.elements()[e]; element.is_cell) cells.push_back(element.number);
  sort_and_unite(cells);
  if (cells.empty()) assembler_.lines().fail(line.place, fmt::format("\"{}\" has no cells", line.fields[0]));
  const bool is_gravity = label == "GRAV";
  const std::size_t n_data = is_gravity ? 3 : 6;
  std::vector<double> data(n_data);
  for (std::size_t i = 0; i < n_data; ++i) data[i] = number(line, 3 + i);
  double* const axis = data.data() + (is_gravity ? 0 : 3);
  const Point<3> direction(axis[0], axis[1], axis[2]);
  if (!(direction.norm() > 0) || !can_act(is_gravity, data))
    assembler_.lines().fail(line.place, fmt::format("{} has no direction in which it can act", label),
                            faces_.is_axisymmetric() ? "along the axis of revolution, which is y: GRAV, "
                                                       "9.81, 0, -1, 0; CENTRIF, omega^2, 0, 0, 0, 0, 1, 0"
                            : is_gravity             ? "Eall, GRAV, 9.81, 0, 0, -1"
                                         : "Eall, CENTRIF, omega^2, point (3), direction of the axis (3)");
  for (int i = 0; i < 3; ++i) axis[i] /= direction.norm();  // only the direction counts
  apply(load_on(is_gravity ? DeckLoadKind::gravity : DeckLoadKind::rotation, block, line.place,
                line.fields[0], std::move(cells), 0, std::move(data)),
        number(line, 2), block);
  log_.add(line.place, "DLOAD", Fate::taken,
           is_gravity ? "body force: density times acceleration" : "body force of the rotation");
}

void DeckReader::read_surface_loads(const Block& block)
{
  note_new(block, distributed_loads);
  for (const Line& line : block.lines)
  {
    const std::string label = mesh::capitals(field(line, 1));
    if (label != "P" && label != "TRVEC")
    {
      log_.drop(line.place, "DSLOAD", fmt::format("the load \"{}\" cannot be imported", field(line, 1)),
                "P, a pressure, and TRVEC, a traction, can");
      continue;
    }
    const std::vector<Index> faces = faces_of_surface(assembler_, faces_, line.fields[0], line.place);
    if (label == "P")
    {
      apply(load_on(DeckLoadKind::pressure, block, line.place, line.fields[0], faces), number(line, 2),
            block);
      continue;
    }
    const Point<3> given(number(line, 3), number(line, 4), number(line, 5));
    if (!(given.norm() > 0)) assembler_.lines().fail(line.place, "TRVEC has no direction");
    const Point<3> direction = given.normalized();
    for (int c = 0; c < faces_.dim(); ++c)
      apply(load_on(DeckLoadKind::traction, block, line.place, line.fields[0], faces, c),
            number(line, 2) * direction[c], block);
  }
  take(block, "pressure or traction");
}

void DeckReader::read_temperature(const Block& block)
{
  note_new(block, std::array{DeckLoadKind::temperature});
  constexpr std::size_t most = 1000;
  struct Group
  {
    const Line* line;
    std::vector<Index> nodes{};
  };
  std::vector<Group> groups;  // in the order of the lines: the last one counts
  for (const Line& line : block.lines)
  {
    const std::vector<Index> nodes = assembler_.nodes_named(field(line, 0), line.place);
    if (groups.empty() || field(*groups.back().line, 1) != field(line, 1)) groups.push_back({&line});
    groups.back().nodes.insert(groups.back().nodes.end(), nodes.begin(), nodes.end());
    if (groups.size() > most)
      return log_.drop(block.keyword.place, "TEMPERATURE", "the temperature varies from node to node",
                       "a formula in load.NAME.temperature of the case");
  }
  for (Group& group : groups)
  {
    sort_and_unite(group.nodes);
    std::map<double, std::vector<Index>> nodes_of_initial;
    for (const Index node : group.nodes) nodes_of_initial[initial_temperature(node)].push_back(node);
    for (auto& [initial, nodes] : nodes_of_initial)
    {
      DeckLoad& load = load_on(DeckLoadKind::temperature, block, group.line->place, field(*group.line, 0),
                               std::move(nodes));
      if (load.course.points().empty()) load.course.add(0, initial);
      apply(load, number(*group.line, 1), block);
    }
  }
  take(block, "temperature");
}

double DeckReader::initial_temperature(Index node) const
{
  double result = 0;
  for (const DeckLoad& initial : deck_.initial_temperatures)
    if (std::ranges::binary_search(initial.members, node)) result = initial.course.last();
  return result;
}

void DeckReader::read_initial_conditions(const Block& block)
{
  const std::string type = mesh::capitals(required(block, "TYPE"));
  if (type != "TEMPERATURE")
    return log_.drop(block.keyword.place, "INITIAL CONDITIONS", fmt::format("of type {}", type),
                     "an initial stress is a load.initial_stress of the case");
  for (const Line& line : block.lines)
  {
    DeckLoad load{DeckLoadKind::temperature, line.place, field(line, 0),
                  assembler_.nodes_named(field(line, 0), line.place)};
    load.course.add(0, number(line, 1));
    deck_.initial_temperatures.push_back(std::move(load));
  }
  take(block, "temperature without expansion");
}

}  // namespace tribound::case_file
