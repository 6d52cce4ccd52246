#include "tribound/case/physics.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "tribound/case/geometry_reader.h"
#include "tribound/case/interface_reader.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

namespace
{

problem::PlaneModel to_plane(const Node& node)
{
  return one_of<problem::PlaneModel>({"strain", "stress"})(node);
}

MaterialConfig read_material(const TableReader& table, std::string region, problem::PlaneModel plane)
{
  MaterialConfig material{.region = std::move(region), .plane = plane, .where = table.where()};
  const Node& E = table.require("E", "Young's modulus, in the units of stress: E = 210e9");
  material.E = to_number_in(E, positive, "Young's modulus in the units of stress, such as 210e9");
  (void)to_number_in(E, reasonable, "squares of stresses must be numbers, too: take other units");
  material.nu = to_number_in(table.require("nu", "Poisson's ratio in (-1, 0.5): nu = 0.3"),
                             {.lower = -1.0, .upper = 0.5},
                             "Poisson's ratio, such as 0.3; nearly incompressible is 0.499, not 0.5");
  table.read("plane", material.plane, to_plane);
  return material;
}

LoadConfig read_load(const TableReader& table, std::string region)
{
  const Node& body = table.require("body", "force per volume: body = [0, -9.81]");
  return {std::move(region), to_fields(body), body.where};
}

std::vector<std::optional<problem::Field>> read_displacement(const Node& node)
{
  std::vector<std::optional<problem::Field>> displacement;
  for (const Node& item :
       to_components(node, "one number, formula or \"free\" per dimension, such as [0, \"free\"]"))
  {
    const auto* text = std::get_if<std::string>(&item.value);
    if (text != nullptr && *text == "free")
      displacement.emplace_back();
    else
      displacement.emplace_back(to_field(item));
  }
  return displacement;
}

problem::Field read_law_value(const TableReader& table, const problem::LawKey& key)
{
  const Node& node = table.require(key.key, std::string(key.meaning));
  if (!key.is_number) return to_nonnegative_field(node);
  return problem::Field(to_number_in(node, not_negative, std::string(key.meaning)), node.where);
}

/// `friction` and the keys that belong to the law it names.
problem::ContactLaw read_law(const TableReader& table, std::span<const problem::LawKind> kinds)
{
  std::vector<std::string> names;
  for (const problem::LawKind& kind : kinds) names.emplace_back(kind.name);
  std::size_t chosen = 0;
  table.read("friction", chosen, [&](const Node& node) { return to_choice(node, names); });
  std::vector<KeyGroup> groups;
  groups.reserve(kinds.size());
  for (const problem::LawKind& kind : kinds)
  {
    KeyGroup& group = groups.emplace_back(KeyGroup{kind.name, {}});
    for (const problem::LawKey& key : kind.keys) group.keys.push_back(key.key);
  }
  refuse_keys_of_others(table, "friction", groups, chosen);
  std::vector<problem::Field> values;
  for (const problem::LawKey& key : kinds[chosen].keys) values.push_back(read_law_value(table, key));
  return kinds[chosen].make(values);
}

/// `friction`, the keys of all laws, and the given ones.
std::vector<std::string_view> law_keys(std::initializer_list<std::string_view> others)
{
  std::vector<std::string_view> keys = {"friction"};
  for (const problem::LawKind& kind : problem::law_kinds())
    for (const problem::LawKey& key : kind.keys) keys.push_back(key.key);
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

/// Sets what touches an obstacle, with the keys that all of these have beside their law.
void set_obstacle(const TableReader& table, problem::Contact contact, BoundaryConfig& boundary)
{
  table.read("gap", *contact.gap, to_field);
  boundary.contact = std::move(contact);
  boundary.geometry = read_obstacle_geometry(table);
}

void read_obstacle(const Node& node, BoundaryConfig& boundary)
{
  const TableReader table(node, law_keys({"gap", "obstacle", "shape", "normal"}));
  set_obstacle(
      table,
      problem::Contact(read_law(table, problem::obstacle_law_kinds()), problem::Field(0.0, node.where)),
      boundary);
}

/// `interface`: what touches an obstacle and remembers.
void read_memory(const Node& node, BoundaryConfig& boundary)
{
  const TableReader table(node, interface_keys({"gap", "obstacle", "shape", "normal"}));
  set_obstacle(table, read_interface(table, problem::Field(0.0, node.where)), boundary);
}

/// A name, or an array of them.
std::vector<std::string> read_names(const Node& node)
{
  constexpr auto hint = "a boundary of the mesh, or an array of them: [\"top\", \"arc\"]";
  const auto* items = std::get_if<Node::Array>(&node.value);
  if (items == nullptr && !std::holds_alternative<std::string>(node.value))
    fail_type(node, "a string or an array", hint);
  if (items != nullptr && items->empty()) throw InputError(node.where, "is empty", hint);
  std::vector<std::string> names;
  for (const Node& item : items != nullptr ? std::span(*items) : std::span(&node, 1))
    names.push_back(to_text(item));
  return names;
}

/// Absent for "geometry".
std::optional<problem::Field> read_gap(const Node& node)
{
  const auto* text = std::get_if<std::string>(&node.value);
  if (text != nullptr && *text == "geometry") return std::nullopt;
  return to_field(node);
}

std::vector<double> read_direction(const Node& node)
{
  return to_direction(node, "\"normal\", or a direction out of the slave, such as [0, -1]");
}

/// The sides: slave and master, or a joint.
void read_sides(const TableReader& table, ContactConfig& config)
{
  if (const Node* joint = table.find("joint"))
  {
    for (const std::string_view key : {"slave", "master"})
      if (const Node* side = table.find(key))
        throw InputError(side->where, "stands beside joint",
                         "a joint is cut open and makes both sides itself; for two boundaries give slave and "
                         "master");
    config.joint = to_text(*joint);
    config.slave = {config.joint};
    config.master = {config.joint + ".other"};
    return;
  }
  constexpr auto hint = "slave = \"...\" and master = \"...\", two boundaries, or joint = \"...\"";
  config.slave = read_names(table.require("slave", hint));
  config.master = read_names(table.require("master", hint));
  for (const std::string& name : config.master)
    if (std::ranges::find(config.slave, name) != config.slave.end())
      throw InputError(table.find("master")->where, fmt::format("\"{}\" is the slave, too", name),
                       "two boundaries, or parts of one that are groups of their own");
}

/// The law of a pair: `friction` and its keys, or `interface`.
problem::Contact read_pair_law(const TableReader& table)
{
  const Node* interface = table.find("interface");
  if (interface == nullptr) return problem::Contact(read_law(table, problem::law_kinds()), std::nullopt);
  for (const std::string_view key : law_keys({}))
    if (const Node* other = table.find(key))
      throw InputError(other->where, "stands beside interface", "it belongs into the table of interface");
  return read_interface(TableReader(*interface, interface_keys()), std::nullopt);
}

ContactConfig read_pair(const Node& node)
{
  const TableReader table(node, law_keys({"slave", "master", "joint", "gap", "pairing", "reach", "shape",
                                          "normal", "interface"}));
  ContactConfig config;
  config.where = node.where;
  read_sides(table, config);
  config.contact = read_pair_law(table);
  if (!cone(config.contact.law).is_tied)
    table.read("gap", config.contact.gap, read_gap);
  else if (const Node* gap = table.find("gap"))
    throw InputError(gap->where, "does not belong to friction = \"tied\"",
                     "what is tied moves as one, whatever lies between");
  else
    config.contact.gap = problem::Field(0.0, node.where);
  config.geometry = read_pair_geometry(table);
  if (cone(config.contact.law).is_tied)
    for (const std::string_view key : {"shape", "normal"})
      if (const Node* of_contact = table.find(key))
        throw InputError(of_contact->where, "does not belong to friction = \"tied\"",
                         "what is tied has neither gap nor direction");
  table.read("pairing", config.direction, read_direction);
  table.read("reach", config.reach,
             number_in(positive, "the largest distance between the sides, a length, such as 0.1"));
  return config;
}

/// Conditions that exclude each other.
void check_boundary(const TableReader& table, const BoundaryConfig& boundary)
{
  const auto fail = [&](std::string_view key, const std::string& problem, const std::string& hint)
  { throw InputError(table.find(key)->where, problem, hint); };
  if (boundary.contact)
    for (const std::string_view key : {"displacement", "traction", "pressure"})
      if (table.has(key))
        fail(
            key,
            fmt::format("stands beside {} on the same boundary",
                        table.has("contact") ? "contact" : "interface"),
            "a part of the boundary is either in contact or has displacement, traction and pressure; "
            "split the group in the mesh; a pressure in the joint itself, such as uplift, is the water of an "
            "interface");
  if (boundary.displacement.empty()) return;

  const auto is_fixed = [](const std::optional<problem::Field>& component) { return component.has_value(); };
  if (boundary.pressure && std::ranges::all_of(boundary.displacement, is_fixed))
    fail("pressure", "has no effect: displacement fixes every component", "drop it, or leave one \"free\"");
  if (boundary.traction.empty()) return;
  if (boundary.traction.size() != boundary.displacement.size())
    fail("traction",
         fmt::format("has {} components, displacement has {}", boundary.traction.size(),
                     boundary.displacement.size()),
         "both have one per dimension");
  for (std::size_t i = 0; i < boundary.traction.size(); ++i)
    if (boundary.displacement[i] && !boundary.traction[i].is_zero())
      throw InputError(boundary.traction[i].where(), "is not 0, but displacement fixes this component",
                       fmt::format("set it to 0, or displacement[{}] to \"free\"", i));
}

BoundaryConfig read_boundary(const Entry& entry)
{
  const TableReader table(entry.node, {"displacement", "traction", "pressure", "contact", "interface"});
  if (std::get<Node::Table>(entry.node.value).empty())
    throw InputError(
        entry.where, "nothing is given on this boundary",
        "displacement, traction, pressure, contact or interface; traction-free is traction = [0, 0]");
  BoundaryConfig boundary;
  boundary.name = entry.name;
  boundary.where = entry.where;
  table.read("displacement", boundary.displacement, read_displacement);
  table.read("traction", boundary.traction, to_fields);
  table.read("pressure", boundary.pressure, to_field);
  const Node* interface = table.find("interface");
  if (const Node* contact = table.find("contact"))
  {
    if (interface != nullptr)
      throw InputError(interface->where, "stands beside contact on the same boundary", "one of them");
    read_obstacle(*contact, boundary);
  }
  if (interface != nullptr) read_memory(*interface, boundary);
  check_boundary(table, boundary);
  return boundary;
}

}  // namespace

std::vector<MaterialConfig> read_materials(const Node& node)
{
  const TableReader table(node, {"E", "nu", "plane"}, TableReader::Subtables::named);
  problem::PlaneModel plane = problem::PlaneModel::strain;
  table.read("plane", plane, to_plane);

  std::vector<MaterialConfig> materials;
  if (table.has("E") || table.has("nu") || table.named().empty())
    materials.push_back(read_material(table, {}, plane));
  for (const Entry* entry : table.named())
    materials.push_back(read_material(TableReader(entry->node, {"E", "nu", "plane"}), entry->name, plane));
  return materials;
}

std::vector<LoadConfig> read_loads(const Node& node)
{
  const TableReader table(node, {"body"}, TableReader::Subtables::named);
  std::vector<LoadConfig> loads;
  if (table.has("body")) loads.push_back(read_load(table, {}));
  for (const Entry* entry : table.named())
    loads.push_back(read_load(TableReader(entry->node, {"body"}), entry->name));
  return loads;
}

std::vector<BoundaryConfig> read_boundaries(const Node& node)
{
  const auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr) fail_type(node, "a table", "one table for each boundary, such as [boundary.top]");
  std::vector<BoundaryConfig> boundaries;
  for (const Entry& entry : *table) boundaries.push_back(read_boundary(entry));
  return boundaries;
}

std::vector<ContactConfig> read_contacts(const Node& node)
{
  const auto* items = std::get_if<Node::Array>(&node.value);
  if (items == nullptr)
    fail_type(node, "an array of tables", "one [[contact]] for each pair, with two brackets on each side");
  std::vector<ContactConfig> contacts;
  for (const Node& item : *items) contacts.push_back(read_pair(item));
  return contacts;
}

}  // namespace tribound::case_file
