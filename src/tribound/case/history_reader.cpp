#include "tribound/case/history_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

namespace
{

constexpr auto steps_hint = "values of t, such as [0, 0.5, 1], or { from = 0, to = 1, count = 11 }";

const Table& equal_steps_table()
{
  static const Table table{
      .name = "history.steps",
      .keys = {{"from", number_in(finite), steps_hint},
               {"to", number_in(finite), steps_hint},
               {"count", integer_from(2, "how many values, both ends included, such as 11", 1'000'000),
                steps_hint}}};
  return table;
}

std::vector<double> equal_steps(const Node& node)
{
  const TableReader table(node, equal_steps_table());
  const auto from = table.get<double>("from");
  const auto to = table.get<double>("to");
  const auto count = table.get<int>("count");
  std::vector<double> steps;
  steps.reserve(count);
  for (int i = 0; i < count; ++i)
    steps.push_back(
        i + 1 == count ? to : from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  return steps;
}

constexpr auto gauge_hint =
    "the mean of a component over a boundary, \"crest.x\", how far a contact boundary opens, "
    "\"base.opening\", or at its heel, \"base.cmod\", and slides there, \"base.csd\"";

struct NamedJump
{
  std::string_view name;
  adapt::Jump jump;
};

constexpr std::array<NamedJump, 4> named_jumps = {{{"opening", adapt::Jump::opening},
                                                   {"heel", adapt::Jump::mouth_opening},
                                                   {"cmod", adapt::Jump::mouth_opening},
                                                   {"csd", adapt::Jump::mouth_sliding}}};

/// "crest.x", "base.opening", "base.cmod"; names of boundaries may contain dots.
adapt::Gauge to_gauge(const std::string& text, double factor, const Where& where)
{
  const std::size_t dot = text.rfind('.');
  const std::string last = dot == std::string::npos ? std::string() : text.substr(dot + 1);
  adapt::Gauge gauge{.boundary = text.substr(0, dot), .factor = factor, .where = where};
  constexpr std::string_view components = "xyz";
  if (last.size() == 1 && components.find(last[0]) != std::string_view::npos)
    gauge.component = static_cast<int>(components.find(last[0]));
  else if (const auto* const named = std::ranges::find(named_jumps, last, &NamedJump::name);
           named != named_jumps.end())
    gauge.jump = named->jump;
  else
    throw InputError(where, fmt::format("\"{}\" is no displacement", text), gauge_hint);
  return gauge;
}

Value gauge_value()
{
  static const Table sum{.name = "history.sum", .named = number_in(finite)};
  return text(gauge_hint) | keys_of(sum);
}

/// One gauge, or a table of gauges with their factors.
std::vector<adapt::Gauge> to_gauges(const Node& node)
{
  if (!node.is_table()) return {to_gauge(to_text(node), 1, node.where)};
  std::vector<adapt::Gauge> gauges;
  for (const Entry& entry : std::get<Node::Table>(node.value))
    gauges.push_back(to_gauge(entry.name, to_number(entry.node), entry.node.where));
  if (gauges.empty()) throw InputError(node.where, "is empty", gauge_hint);
  return gauges;
}

/// A prescribed displacement; `until` is required unless something else ends the stage.
const Table& displacement_table(bool needs_end)
{
  constexpr auto until = "the value at which the path ends";
  const auto make = [](bool needs_until)
  {
    return Table{.name = "history.then",
                 .keys = {{"displacement", gauge_value(), gauge_hint},
                          {"step", number_in(finite), "by how much it grows in a load step, such as 1e-3"},
                          {"until", number_in(finite, until), needs_until ? until : ""}}};
  };
  static const Table endless = make(false);
  static const Table ending = make(true);
  return needs_end ? ending : endless;
}

adapt::DisplacementStage to_displacement(const Node& node, bool needs_end)
{
  const TableReader table(node, displacement_table(needs_end));
  adapt::DisplacementStage stage;
  stage.gauges = to_gauges(table.require("displacement"));
  stage.step = table.get<double>("step");
  if (stage.step == 0) throw InputError(table.find("step")->where, "is 0", table.key_of("step").missing);
  if (stage.step < 0) stage.until *= -1;
  if (needs_end) (void)table.require("until");
  table.read("until", stage.until);
  return stage;
}

void read_control(const Node& node, const Value& value, adapt::PathProgram& program)
{
  if (!node.is_table())
  {
    convert(node, value, program.following);
    return;
  }
  program.following = adapt::Following::displacement;
  program.displacement = to_displacement(node, false);
}

const Options<adapt::PathProgram>& stop_options()
{
  using P = adapt::PathProgram;
  static const Options<P> options(
      "history.stop",
      {option<&P::enough_damage>("damage", number_in({.lower = 0.0, .upper = 1.0, .includes_upper = true},
                                                     "the mean damage of all interfaces, such as 0.95")),
       option<&P::t_min>("t_min", number_in(finite, "the t at which the path ends, after its peak")),
       option<&P::max_steps>("steps", integer_from(1, "a number of load steps, such as 100"))});
  return options;
}

void read_steps(const Node& steps, std::vector<double>& targets)
{
  targets.clear();
  const auto* items = std::get_if<Node::Array>(&steps.value);
  if (steps.is_table())
    targets = equal_steps(steps);
  else if (items == nullptr)
    fail_type(steps, "an array of numbers or a table", steps_hint);
  else
    for (const Node& item : *items) targets.push_back(to_number(item));
  if (targets.empty()) throw InputError(steps.where, "is empty", steps_hint);
}

std::vector<adapt::Watch> read_watch(const Node& node)
{
  if (!node.is_table()) fail_type(node, "a table", "names with what they watch: { crest = \"crest.x\" }");
  std::vector<adapt::Watch> watch;
  for (const Entry& entry : std::get<Node::Table>(node.value))
    watch.push_back({entry.name, to_gauges(entry.node)});
  return watch;
}

HistoryConfig read_history(const Node& node)
{
  const TableReader table(node, history_table());
  HistoryConfig history{.where = node.where};
  adapt::PathProgram& program = history.program;
  read_steps(table.require("steps"), program.targets);
  if (const Node* control = table.find("control"))
    read_control(*control, table.key_of("control").value, program);
  table.read("damage_step", program.damage_step);
  if (const Node* stop = table.find("stop")) stop_options().read(*stop, program);
  if (const Node* then = table.find("then")) program.then = to_displacement(*then, true);
  if (const Node* watch = table.find("watch")) history.watch = read_watch(*watch);
  table.read("refine", history.refine);
  table.read("check", history.check);
  return history;
}

bool remembers(const std::optional<problem::Contact>& contact)
{
  return contact && problem::has_memory(contact->law);
}

bool can_be_damaged(const std::optional<problem::Contact>& contact)
{
  return contact && problem::cone(contact->law).is_bonded;
}

bool is_endo(const std::optional<problem::Contact>& contact)
{
  return contact && std::holds_alternative<problem::EndoLaw>(contact->law);
}

/// Whether the condition holds for any contact of the case.
bool any_contact(const Config& config, bool (*is_so)(const std::optional<problem::Contact>&))
{
  return std::ranges::any_of(config.boundaries, is_so, &BoundaryConfig::contact) ||
         std::ranges::any_of(config.contacts, is_so, &ContactConfig::contact);
}

/// Throws where the path cannot be continued beyond its values of t as the table requires.
void check_control(const TableReader& table, const Config& config)
{
  const adapt::PathProgram& program = config.history->program;
  const bool by_damage =
      program.following == adapt::Following::damage || program.following == adapt::Following::automatic;
  const auto refuse = [&](std::string_view key, const char* problem, const char* hint)
  {
    if (const Node* node = table.find(key)) throw InputError(node->where, problem, hint);
  };
  if (by_damage && !any_contact(config, can_be_damaged))
    refuse("control", "is controlled by damage, but no interface has a bond",
           "an interface with a bond, or \"load\"");
  if (by_damage && any_contact(config, is_endo))
    refuse("control", "is controlled by damage, which law = \"endo\" does not support",
           "{ displacement = ..., step = ... }");
  if (!by_damage) refuse("damage_step", "requires control by damage", "control = \"auto\" or \"damage\"");
  if (program.following != adapt::Following::load)
  {
    if (std::ranges::adjacent_find(program.targets, std::ranges::not_equal_to()) == program.targets.end())
      refuse("steps", "is too short: beyond it the path is extrapolated from two steps",
             "one more value of t");
    return;
  }
  constexpr auto hint = "control = \"auto\", \"damage\" or { displacement = ..., step = ... }";
  refuse("stop", "requires a path that continues after the values of t", hint);
  refuse("then", "requires a path that continues after the values of t", hint);
}

}  // namespace

const Table& history_table()
{
  static const Table watch{.name = "history.watch", .named = gauge_value()};
  static const Table table{
      .name = "history",
      .keys = {
          {"steps", array_of(number_in(finite), 1, steps_hint) | keys_of(equal_steps_table()), steps_hint},
          {"control", one_of({"load", "auto", "damage"}) | keys_of(displacement_table(false))},
          {"damage_step",
           number_in(positive, "length or area that is damaged anew in a load step, such as 0.5")},
          {"stop", keys_of(stop_options().table())},
          {"then", keys_of(displacement_table(true))},
          {"watch", keys_of(watch)},
          {"refine", one_of({"replay", "transfer", "none"})},
          {"check", truth()}}};
  return table;
}

void read_load_steps(const TableReader& root, Config& config)
{
  if (const Node* history = root.find("history")) config.history = read_history(*history);
  if (!config.history && any_contact(config, remembers)) config.history.emplace();
  // The bounds do not cover errors in the history left by earlier steps: steps are solved to the end.
  if (config.history) config.method.stopping.criterion = adapt::Stopping::last_bounded;
}

void check_load_steps(const TableReader& root, Config& config)
{
  if (!config.history)
  {
    if (config.output.checkpoints == Checkpoints::all)
      throw InputError({.file = config.file, .key = "output.checkpoint"},
                       "is \"all\", one for each load step, and there are none", "true");
    return;
  }
  if (config.method.regularisation)
    throw InputError(root.find("regularisation")->where,
                     root.has("history") ? "stands beside [history]" : "stands beside an interface",
                     "drop it: load steps go by the plain method");
  if (config.history->refine == Refine::none) config.adapt.max_levels = 0;
  if (const Node* history = root.find("history"))
    check_control(TableReader(*history, history_table()), config);
}

}  // namespace tribound::case_file
