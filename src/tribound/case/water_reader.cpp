#include "tribound/case/water_reader.h"

#include <fmt/format.h>

#include <span>
#include <string>
#include <utility>

namespace tribound::case_file
{

namespace
{

constexpr auto weight_hint = "of the water per volume, such as 9.81e-3 in MN and m";
constexpr auto line_hint = "two points of the base, upstream and downstream: heel = [0, 0], toe = [60, 0]";

problem::BaseLine read_line(const TableReader& table)
{
  const Node& heel = table.require("heel", line_hint);
  const Node& toe = table.require("toe", line_hint);
  problem::BaseLine line{{}, {}, heel.where};
  table.read("heel", line.heel);
  table.read("toe", line.toe);
  if (line.toe.size() != line.heel.size())
    throw InputError(toe.where,
                     fmt::format("has {} components, heel has {}", line.toe.size(), line.heel.size()),
                     "both have one per dimension");
  if (line.length() == 0) throw InputError(toe.where, "is the heel, too", line_hint);
  return line;
}

/// A height, which may depend on t.
problem::Field read_level(const Node& node)
{
  problem::Field level = to_field(node);
  if (!level.is_constant())
    throw InputError(node.where, "varies in space", "a level of the water: a number, or a formula in t");
  return level;
}

const Table& drain_table()
{
  constexpr auto efficiency_hint = "0 for none to 1, such as 0.67";
  static const Table table{
      .name = "drain",
      .keys = {{"at", number_in(positive), "its distance from the heel along the base, such as 8"},
               {"efficiency",
                number_in({.lower = 0, .upper = 1, .includes_lower = true, .includes_upper = true},
                          efficiency_hint),
                efficiency_hint},
               {"rule", one_of({"linear", "usbr"})}}};
  return table;
}

problem::Drain read_drain(const Node& node, double length)
{
  enum class Rule
  {
    linear,
    usbr
  };
  const TableReader table(node, drain_table());
  auto rule = Rule::linear;
  table.read("rule", rule);
  return {.at = to_number_in(table.require("at"), {.lower = 0, .upper = length},
                             fmt::format("a distance from the heel, more than 0 and less than {:.6g}, the "
                                         "length of the base",
                                         length)),
          .efficiency = table.get<double>("efficiency"),
          .from_full_head = rule == Rule::usbr};
}

problem::Seepage read_seepage(const TableReader& table)
{
  constexpr auto hint = "pressure = \"...\", or head and weight with heel and toe";
  const Node& head = table.require("head", hint);
  (void)table.require("weight", weight_hint);
  problem::Seepage seepage{
      .head = read_level(head), .weight = table.get<double>("weight"), .line = read_line(table)};
  if (const Node* tail = table.find("tail")) seepage.tail = read_level(*tail);
  // Without water downstream, the level is the height of the toe, or anything below.
  if (!table.has("tail")) seepage.tail = problem::Field(0.0, head.where);
  table.read("crack", seepage.crack);
  if (const Node* drain = table.find("drain")) seepage.drain = read_drain(*drain, seepage.line.length());
  return seepage;
}

}  // namespace

const Table& water_table()
{
  static const Table table = []
  {
    Table water{.name = "water",
                .keys = {{"pressure", nonnegative_datum()},
                         {"head", datum()},
                         {"tail", datum()},
                         {"weight", number_in(positive, weight_hint)},
                         {"heel", numbers()},
                         {"toe", numbers()},
                         {"crack", truth()},
                         {"drain", keys_of(drain_table())}},
                .one_of = {"pressure", "head"},
                .relations = {{.key = "pressure"}, {.key = "head", .needs = {"weight", "heel", "toe"}}}};
    for (const Key& key : std::span(water.keys).subspan(1)) water.relations[0].excludes.push_back(key.name);
    return water;
  }();
  return table;
}

void read_water(const TableReader& interface, problem::Contact& contact)
{
  if (interface.has("heel") || interface.has("toe")) contact.base = read_line(interface);
  const Node* node = interface.find("water");
  if (node == nullptr) return;
  const TableReader table(*node, water_table());
  if (const Node* other = table.excluded_by("pressure"))
    throw InputError(other->where, "stands beside pressure",
                     "give water by its pressure or by its levels; heel and toe for the figures belong "
                     "beside water");
  if (table.has("pressure"))
  {
    contact.water.emplace(table.get<problem::Field>("pressure"));
    return;
  }
  for (const char* key : {"heel", "toe"})
    if (const Node* other = interface.find(key))
      throw InputError(other->where, "is also given in water",
                       "the line of the water is that of the figures, too");
  problem::Seepage seepage = read_seepage(table);
  contact.base = seepage.line;
  contact.water.emplace(std::move(seepage));
}

}  // namespace tribound::case_file
