#include "tribound/case/quantity_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "tribound/case/dimension.h"

namespace tribound::case_file
{

namespace
{

using problem::QuantityKind;

/// In the order of QuantityKind, with the keys of each besides `name` and `kind`.
const std::array kinds = {
    KeyGroup{to_string(QuantityKind::energy)},
    KeyGroup{to_string(QuantityKind::load_work)},
    KeyGroup{to_string(QuantityKind::contact_force), {"boundary", "direction", "ramp"}},
    KeyGroup{to_string(QuantityKind::contact_moment), {"boundary", "direction", "point", "ramp"}},
    KeyGroup{to_string(QuantityKind::safety_factor), {"boundary", "ramp"}, {"boundary"}},
    KeyGroup{to_string(QuantityKind::mean_displacement), {"boundary", "direction"}, {"boundary"}},
    KeyGroup{to_string(QuantityKind::spring_force), {"boundary", "direction"}, {"boundary"}}};

/// Throws where a quantity is not defined without a key.
void require_keys(const TableReader& table, const QuantityConfig& quantity)
{
  table.require_group(static_cast<std::size_t>(quantity.kind));
  const bool is_of_all = quantity.boundary.empty();
  if (is_of_all && quantity.kind == QuantityKind::contact_force)
    (void)table.require("direction", "of the force, a vector such as [0, 1]");
  if (is_of_all && quantity.direction.empty() && table.has("direction"))
    throw InputError(table.find("direction")->where, "is \"normal\" without a boundary",
                     "a vector such as [0, 1], or boundary = \"...\"");
}

QuantityConfig read_quantity(const Node& node)
{
  const TableReader table(node, quantity_table());
  QuantityConfig quantity{.kind = static_cast<QuantityKind>(table.choose()), .where = node.where};
  table.read("boundary", quantity.boundary);
  table.read("direction", quantity.direction);
  table.read("point", quantity.point);
  table.read("ramp", quantity.ramp);
  require_keys(table, quantity);
  quantity.name = to_string(quantity.kind);
  if (!quantity.boundary.empty()) quantity.name += " " + quantity.boundary;
  table.read("name", quantity.name);
  return quantity;
}

template <int dim>
Point<dim> in_dimension(const std::vector<double>& x, std::string_view key, const QuantityConfig& quantity)
{
  check_length<dim>(x.size(), inside(quantity.where, key));
  return Eigen::Map<const Point<dim>>(x.data());
}

}  // namespace

const Table& quantity_table()
{
  constexpr auto direction_hint =
      "\"normal\", the outward normal of the boundary, or a vector such as [0, 1]";
  static const Table table = []
  {
    std::vector<std::string> words;
    words.reserve(kinds.size());
    for (const KeyGroup& kind : kinds) words.emplace_back(kind.word);
    return Table{
        .name = "quantity",
        .keys = {{"name", text("a name, such as \"thrust\"", 1)},
                 {"kind", one_of(words), "what is wanted, such as kind = \"contact_force\""},
                 {"boundary", text("the boundary whose number it is")},
                 {"direction", direction(direction_hint) | one_of({"normal"})},
                 {"point", numbers()},
                 {"ramp",
                  number_in(positive, "a distance, over which the weight of a force grows from 0 to 1")}},
        .choice = "kind",
        .groups = {kinds.begin(), kinds.end()}};
  }();
  return table;
}

std::vector<QuantityConfig> read_quantities(const Node& node)
{
  const auto* items = std::get_if<Node::Array>(&node.value);
  if (items == nullptr)
    fail_type(node, "an array of tables", "one [[quantity]] for each number, with two brackets on each side");
  std::vector<QuantityConfig> quantities;
  for (const Node& item : *items)
  {
    QuantityConfig quantity = read_quantity(item);
    if (std::ranges::find(quantities, quantity.name, &QuantityConfig::name) != quantities.end())
      throw InputError(quantity.where, fmt::format("has the name of another one, \"{}\"", quantity.name),
                       "name = \"...\" of its own");
    quantities.push_back(std::move(quantity));
  }
  return quantities;
}

namespace
{

void check_goal(const TableReader& root, const Config& config)
{
  const adapt::ErrorBars& bars = config.adapt.bars;
  const Node* adapt = root.find("adapt");
  if (bars.goal.empty())
  {
    if (bars.goal_tolerance)
      throw InputError(adapt->where, "has a goal_tolerance without a goal",
                       "goal = \"...\", the name of a [[quantity]]");
    return;
  }
  std::vector<std::string> names;
  for (const QuantityConfig& quantity : config.quantities) names.push_back(quantity.name);
  if (std::ranges::find(names, bars.goal) == names.end())
    throw InputError(adapt->where, fmt::format("has the goal \"{}\", which is no [[quantity]]", bars.goal),
                     names.empty() ? std::string("a [[quantity]] of this name")
                                   : fmt::format("one of {}", problem::quoted_list(names)));
}

}  // namespace

void check_error_bars(const TableReader& root, Config& config)
{
  check_goal(root, config);
  adapt::ErrorBars& bars = config.adapt.bars;
  const bool is_steering =
      config.adapt.measure == adapt::ErrorMeasure::energy || bars.energy_tolerance || !bars.goal.empty();
  const Node* certify = root.find("certify");
  const Entry* given = certify ? find(std::get<Node::Table>(certify->value), "energy") : nullptr;
  if (config.history)
  {
    if (is_steering)
      throw InputError(root.find("adapt")->where,
                       "steers the meshes by the error in the energy norm, and there are load steps",
                       "the bound of the residual refines meshes of load steps: drop adapt.goal, "
                       "adapt.energy_tolerance and adapt.measure");
  }
  if (given && is_steering && !bars.on_every_level())
    throw InputError(
        given->where, fmt::format("is {}", describe(given->node)),
        "\"every\", as adapt.measure = \"energy\", adapt.energy_tolerance and adapt.goal need the "
        "bound on every mesh");
  if (given && !config.quantities.empty() && bars.levels == adapt::EnergyLevels::off)
    throw InputError(given->where, "is \"off\", and there is a [[quantity]]", "\"last\" or \"every\"");
  if (!given) bars.levels = is_steering ? adapt::EnergyLevels::every : adapt::EnergyLevels::last;
}

template <int dim>
std::vector<problem::Quantity<dim>> resolve_quantities(const Config& config,
                                                       const problem::Problem<dim>& problem,
                                                       std::span<const std::string> boundary_names)
{
  std::vector<problem::Quantity<dim>> quantities;
  for (const QuantityConfig& given : config.quantities)
  {
    problem::Quantity<dim> quantity{.name = given.name,
                                    .kind = given.kind,
                                    .boundary = given.boundary,
                                    .direction = {},
                                    .point = {},
                                    .ramp = given.ramp,
                                    .where = given.where};
    if (!given.direction.empty()) quantity.direction = in_dimension<dim>(given.direction, "direction", given);
    if (!given.point.empty()) quantity.point = in_dimension<dim>(given.point, "point", given);
    (void)problem::boundary_number(quantity, problem, boundary_names);  // throws where it has none
    quantities.push_back(std::move(quantity));
  }
  return quantities;
}

template std::vector<problem::Quantity<2>> resolve_quantities(const Config&, const problem::Problem<2>&,
                                                              std::span<const std::string>);
template std::vector<problem::Quantity<3>> resolve_quantities(const Config&, const problem::Problem<3>&,
                                                              std::span<const std::string>);

}  // namespace tribound::case_file
