#include "tribound/case/water_reader.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

namespace tribound::case_file
{

namespace
{

constexpr auto line_hint = "two points of the base, upstream and downstream: heel = [0, 0], toe = [60, 0]";

problem::BaseLine read_line(const TableReader& table)
{
  const Node& heel = table.require("heel", line_hint);
  const Node& toe = table.require("toe", line_hint);
  problem::BaseLine line{to_numbers(heel), to_numbers(toe), heel.where};
  if (line.toe.size() != line.heel.size())
    throw InputError(toe.where,
                     fmt::format("has {} components, heel has {}", line.toe.size(), line.heel.size()),
                     "both have one per dimension");
  if (line.length() == 0) throw InputError(toe.where, "is the heel, too", line_hint);
  return line;
}

/// A height, maybe in t.
problem::Field read_level(const Node& node)
{
  problem::Field level = to_field(node);
  if (!level.is_constant())
    throw InputError(node.where, "varies in space", "a level of the water: a number, or a formula in t");
  return level;
}

problem::Drain read_drain(const Node& node, double length)
{
  enum class Rule
  {
    linear,
    usbr
  };
  const TableReader table(node, {"at", "efficiency", "rule"});
  const Node& at = table.require("at", "its distance from the heel along the base, such as 8");
  const Node& efficiency = table.require("efficiency", "0 for none to 1, such as 0.67");
  auto rule = Rule::linear;
  table.read("rule", rule, one_of<Rule>({"linear", "usbr"}));
  return {.at = to_number_in(at, {.lower = 0, .upper = length},
                             fmt::format("a distance from the heel, more than 0 and less than {:.6g}, the "
                                         "length of the base",
                                         length)),
          .efficiency = to_number_in(efficiency,
                                     {.lower = 0, .upper = 1, .includes_lower = true, .includes_upper = true},
                                     "0 for none to 1, such as 0.67"),
          .from_full_head = rule == Rule::usbr};
}

constexpr std::array level_keys = {"head", "tail", "weight", "heel", "toe", "crack", "drain"};

problem::Seepage read_seepage(const TableReader& table)
{
  constexpr auto hint = "pressure = \"...\", or head and weight with heel and toe";
  const Node& head = table.require("head", hint);
  const Node& weight = table.require("weight", "of the water per volume, such as 9.81e-3 in MN and m");
  problem::Seepage seepage{.head = read_level(head),
                           .weight = to_number_in(weight, positive, "per volume, such as 9.81e-3"),
                           .line = read_line(table)};
  table.read("tail", seepage.tail, read_level);
  // Without water downstream that level is the height of the toe, or anything below.
  if (!table.has("tail")) seepage.tail = problem::Field(0.0, head.where);
  table.read("crack", seepage.crack, to_bool);
  if (const Node* drain = table.find("drain")) seepage.drain = read_drain(*drain, seepage.line.length());
  return seepage;
}

}  // namespace

void read_water(const TableReader& interface, problem::Contact& contact)
{
  if (interface.has("heel") || interface.has("toe")) contact.base = read_line(interface);
  const Node* node = interface.find("water");
  if (node == nullptr) return;
  const TableReader table(*node, {"pressure", "head", "tail", "weight", "heel", "toe", "crack", "drain"});
  if (const Node* pressure = table.find("pressure"))
  {
    for (const char* key : level_keys)
      if (const Node* other = table.find(key))
        throw InputError(
            other->where, "stands beside pressure",
            "water is given by its pressure or by its levels; heel and toe for the figures stand "
            "beside water");
    contact.water.emplace(to_nonnegative_field(*pressure));
    return;
  }
  for (const char* key : {"heel", "toe"})
    if (const Node* other = interface.find(key))
      throw InputError(other->where, "stands beside water that has its own",
                       "the line of the water is that of the figures, too");
  problem::Seepage seepage = read_seepage(table);
  contact.base = seepage.line;
  contact.water.emplace(std::move(seepage));
}

}  // namespace tribound::case_file
