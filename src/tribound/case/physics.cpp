#include "tribound/case/physics.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "tribound/case/geometry_reader.h"
#include "tribound/case/group_reader.h"
#include "tribound/case/interface_reader.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

namespace
{

/// `friction`, the keys of its laws, and the given keys.
Table with_friction(std::string name, std::span<const problem::LawKind> kinds, const std::vector<Key>& others)
{
  Table table{.name = std::move(name), .choice = "friction"};
  std::vector<std::string> words;
  std::vector<Key> keys;
  for (const problem::LawKind& kind : kinds)
  {
    words.emplace_back(kind.name);
    KeyGroup& group = table.groups.emplace_back(KeyGroup{kind.name});
    for (const problem::LawKey& key : kind.keys)
    {
      const std::string meaning(key.meaning);
      keys.push_back({std::string(key.key),
                      key.is_number ? number_in(not_negative, meaning) : nonnegative_datum(meaning)});
      group.keys.emplace_back(key.key);
    }
    group.required = group.keys;
  }
  table.keys = std::vector<Key>{{"friction", one_of(words)}} + keys + others;
  return table;
}

/// `friction` and the keys of the law it names.
problem::ContactLaw read_law(const TableReader& table, std::span<const problem::LawKind> kinds)
{
  const std::size_t chosen = table.choose();
  table.require_group(chosen);
  const problem::LawKind& kind = kinds[chosen];
  std::vector<problem::Field> values;
  for (const problem::LawKey& key : kind.keys)
  {
    const Value& value = table.key_of(key.key).value;
    const Node& node = *table.find(key.key);
    if (key.is_number)
      values.emplace_back(to_number_in(node, *value.number, value.hint), node.where);
    else
      table.read(key.key, values.emplace_back());
  }
  return kind.make(values);
}

/// The keys common to all contact with an obstacle, besides the law.
std::vector<Key> obstacle_keys()
{
  return std::vector<Key>{{"gap", datum()}} + obstacle_geometry_keys();
}

const Table& obstacle_contact_table()
{
  static const Table table =
      with_friction("boundary.NAME.contact", problem::obstacle_law_kinds(), obstacle_keys());
  return table;
}

const Table& obstacle_interface_table()
{
  static const Table table = interface_table(obstacle_keys());
  return table;
}

const Table& spring_table()
{
  static const Table table{.name = "boundary.NAME.spring",
                           .keys = {{"normal", nonnegative_datum()},
                                    {"tangential", nonnegative_datum()},
                                    {"rest", data("one number or formula per dimension")}}};
  return table;
}

constexpr auto fixed_hint = "translations x, y, z and rotations rx, ry, rz; in 2D x, y and rz";

const Table& rigid_table()
{
  static const Table table{
      .name = "boundary.NAME.rigid",
      .keys = {
          {"force", data("one number or formula of t per dimension, such as [0, -100]")},
          {"moment", datum() | array_of(datum(), 3, "in 2D one number without brackets, in 3D one per axis")},
          {"point", numbers()},
          {"fixed", array_of(one_of({problem::motion_names<3>.begin(), problem::motion_names<3>.end()}), 1,
                             fixed_hint)}}};
  return table;
}

const Table& boundary_table()
{
  static const Table table{
      .name = "boundary.NAME",
      .keys =
          std::vector<Key>{
              {"displacement",
               vector_of(datum() | one_of({"free"}),
                         "one number, formula or \"free\" per dimension, such as [0, \"free\"]")},
              {"traction", data()},
              {"pressure", datum()},
              {"spring", nonnegative_datum("stress per length, or { normal, tangential, rest }") |
                             keys_of(spring_table())},
              {"contact", keys_of(obstacle_contact_table())},
              {"interface", keys_of(obstacle_interface_table())},
              {"slider", datum()},
              {"rigid", keys_of(rigid_table())}} +
          slider_geometry_keys() + group_keys(),
      .relations = {{.key = "contact",
                     .excludes = {"displacement", "traction", "pressure", "spring", "interface", "slider",
                                  "rigid"}},
                    {.key = "interface",
                     .excludes = {"displacement", "traction", "pressure", "spring", "slider", "rigid"}},
                    {.key = "slider",
                     .excludes = {"displacement", "traction", "pressure", "spring", "rigid"}},
                    {.key = "rigid", .excludes = {"displacement", "traction", "pressure", "spring"}},
                    {.key = "shape", .needs = {"slider"}},
                    {.key = "normal", .needs = {"slider"}}},
      .refused = point_loads()};
  return table;
}

/// Sets contact with an obstacle, with the common keys besides the law.
void set_obstacle(const TableReader& table, problem::Contact contact, BoundaryConfig& boundary)
{
  table.read("gap", *contact.gap);
  boundary.contact = std::move(contact);
  boundary.geometry = read_obstacle_geometry(table);
}

void read_obstacle(const Node& node, BoundaryConfig& boundary)
{
  const TableReader table(node, obstacle_contact_table());
  set_obstacle(
      table,
      problem::Contact(read_law(table, problem::obstacle_law_kinds()), problem::Field(0.0, node.where)),
      boundary);
}

/// `interface`: contact with an obstacle with history.
void read_memory(const Node& node, BoundaryConfig& boundary)
{
  const TableReader table(node, obstacle_interface_table());
  set_obstacle(table, read_interface(table, problem::Field(0.0, node.where)), boundary);
}

/// `slider`: the displacement along the normal is given, in tension, too.
void read_slider(const TableReader& table, BoundaryConfig& boundary)
{
  problem::Contact contact(problem::Slider(), problem::Field(0.0, table.find("slider")->where));
  table.read("slider", *contact.gap);
  boundary.contact = std::move(contact);
  boundary.geometry = read_slider_geometry(table);
}

/// One stiffness, or those along and across the normal and where the spring rests.
void read_spring(const TableReader& of_boundary, BoundaryConfig& boundary)
{
  const Node& node = *of_boundary.find("spring");
  SpringConfig& spring = boundary.spring.emplace();
  spring.where = node.where;
  if (std::holds_alternative<Node::Array>(node.value))
    fail_type(node, "one stiffness, or those along and across the normal",
              "spring = 1e7, or { normal = 1e7, tangential = 1e6 }");
  if (!node.is_table())
  {
    of_boundary.read("spring", spring.normal);
    problem::refuse_time(spring.normal);
    spring.tangential = spring.normal;
    return;
  }
  const TableReader table(node, spring_table());
  table.read("normal", spring.normal);
  table.read("tangential", spring.tangential);
  table.read("rest", spring.rest);
  problem::refuse_time(spring.normal);
  problem::refuse_time(spring.tangential);
  if (!table.has("normal") && !table.has("tangential"))
    throw InputError(node.where, "has no stiffness",
                     "normal = 1e7, tangential = 1e6, or spring = 1e7 for both");
}

/// A part that moves as a rigid body.
void read_rigid(const Node& node, BoundaryConfig& boundary)
{
  const TableReader table(node, rigid_table());
  RigidConfig& rigid = boundary.rigid.emplace();
  rigid.where = node.where;
  table.read("force", rigid.force);
  const Node* moment = table.find("moment");
  if (moment != nullptr && !std::holds_alternative<Node::Array>(moment->value))
    table.read("moment", rigid.moment.emplace_back());
  else
    table.read("moment", rigid.moment);
  table.read("point", rigid.point);
  table.read("fixed", rigid.fixed);
}

/// The sides: slave and master, or a joint.
void read_sides(const TableReader& table, ContactConfig& config)
{
  if (const Node* joint = table.find("joint"))
  {
    if (const Node* side = table.excluded_by("joint"))
      throw InputError(side->where, "stands beside joint",
                       "a joint is cut open and makes both sides itself; for two boundaries give slave and "
                       "master");
    config.joint = to_text(*joint);
    config.slave = {config.joint};
    config.master = {config.joint + ".other"};
    return;
  }
  constexpr auto hint = "slave = \"...\" and master = \"...\", two boundaries, or joint = \"...\"";
  (void)table.require("slave", hint);
  table.read("slave", config.slave);
  (void)table.require("master", hint);
  table.read("master", config.master);
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
  if (const Node* other = table.excluded_by("interface"))
    throw InputError(other->where, "stands beside interface", "move it to the interface table");
  return read_interface(TableReader(*interface, interface_table()), std::nullopt);
}

ContactConfig read_pair(const Node& node)
{
  const TableReader table(node, pair_table());
  ContactConfig config;
  config.where = node.where;
  read_sides(table, config);
  config.contact = read_pair_law(table);
  if (!cone(config.contact.law).is_tied)
    table.read("gap", config.contact.gap);
  else if (const Node* gap = table.find("gap"))
    throw InputError(gap->where, "does not belong to friction = \"tied\"",
                     "tied sides move together, whatever the gap between them");
  else
    config.contact.gap = problem::Field(0.0, node.where);
  config.geometry = read_pair_geometry(table);
  if (cone(config.contact.law).is_tied)
    for (const std::string_view key : {"shape", "normal"})
      if (const Node* of_contact = table.find(key))
        throw InputError(of_contact->where, "does not belong to friction = \"tied\"",
                         "what is tied has neither gap nor direction");
  table.read("pairing", config.direction);
  table.read("reach", config.reach);
  return config;
}

/// Checks for mutually exclusive conditions.
void check_boundary(const TableReader& table, const BoundaryConfig& boundary)
{
  const auto fail = [&](std::string_view key, const std::string& problem, const std::string& hint)
  { throw InputError(table.find(key)->where, problem, hint); };
  if (const Node* other = table.has("rigid") ? table.excluded_by("rigid") : nullptr)
    throw InputError(other->where, "stands beside rigid on the same boundary",
                     "forces and moments in the table rigid, and what cannot move in its list fixed");
  for (const std::string_view kind : {"contact", "interface", "slider"})
    if (const Node* other = table.excluded_by(kind))
      throw InputError(
          other->where, fmt::format("stands beside {} on the same boundary", kind),
          "a part of the boundary is either in contact or has displacement, traction, pressure and spring; "
          "split the group in the mesh; a pressure in the joint itself, such as uplift, is the water of an "
          "interface");
  for (const std::string_view key : {"shape", "normal"})
    if (table.has(key) && !table.has("slider"))
      fail(key, "belongs to a slider", "slider = 0, or " + std::string(key) + " in the table of the contact");
  if (boundary.displacement.empty()) return;

  const auto is_fixed = [](const std::optional<problem::Field>& component) { return component.has_value(); };
  if (boundary.spring && std::ranges::all_of(boundary.displacement, is_fixed))
    fail("spring", "has no effect: displacement fixes every component", "drop it, or leave one \"free\"");
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
  const TableReader table(entry.node, boundary_table());
  if (std::get<Node::Table>(entry.node.value).empty())
    throw InputError(entry.where, "nothing is given on this boundary",
                     "displacement, traction, pressure, spring, contact, interface, slider or rigid; "
                     "traction-free is traction = [0, 0]");
  BoundaryConfig boundary;
  boundary.name = entry.name;
  boundary.where = entry.where;
  table.read("displacement", boundary.displacement);
  table.read("traction", boundary.traction);
  table.read("pressure", boundary.pressure);
  if (table.has("spring")) read_spring(table, boundary);
  const Node* interface = table.find("interface");
  if (const Node* contact = table.find("contact"))
  {
    if (interface != nullptr)
      throw InputError(interface->where, "stands beside contact on the same boundary", "one of them");
    read_obstacle(*contact, boundary);
  }
  if (interface != nullptr) read_memory(*interface, boundary);
  if (const Node* rigid = table.find("rigid")) read_rigid(*rigid, boundary);
  if (table.has("slider") && !boundary.contact) read_slider(table, boundary);
  check_boundary(table, boundary);
  return boundary;
}

}  // namespace

const Table& boundaries_table()
{
  static const Table table{.name = "boundary", .named = keys_of(boundary_table())};
  return table;
}

const Table& pair_table()
{
  constexpr auto names_hint = "a boundary of the mesh, or an array of them: [\"top\", \"arc\"]";
  constexpr auto pairing_hint = "\"normal\", or a direction out of the slave, such as [0, -1]";
  static const Table interface = interface_table();
  static const Table table = []
  {
    const Value names = array_of(text(), 1, names_hint) | text();
    Table pair = with_friction(
        "contact", problem::law_kinds(),
        std::vector<Key>{
            {"slave", names},
            {"master", names},
            {"joint", text()},
            {"gap", datum() | one_of({"geometry"})},
            {"pairing", direction(pairing_hint) | one_of({"normal"})},
            {"reach", number_in(positive, "the largest distance between the sides, a length, such as 0.1")}} +
            pair_geometry_keys() + std::vector<Key>{{"interface", keys_of(interface)}});
    pair.one_of = {"joint", "slave"};
    pair.relations = {{.key = "slave", .needs = {"master"}},
                      {.key = "master", .needs = {"slave"}},
                      {.key = "joint", .excludes = {"slave", "master"}},
                      {.key = "interface", .excludes = {pair.choice}}};
    for (const KeyGroup& group : pair.groups)
      for (const std::string& key : group.keys) pair.relations.back().excludes.push_back(key);
    return pair;
  }();
  return table;
}

std::vector<BoundaryConfig> read_boundaries(const Node& node)
{
  const auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr) fail_type(node, "a table", "one table for each boundary, such as [boundary.top]");
  std::vector<BoundaryConfig> boundaries;
  for (const Entry& entry : *table)
    if (!gives_only_a_group(entry.node)) boundaries.push_back(read_boundary(entry));
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
