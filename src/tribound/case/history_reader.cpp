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

std::vector<double> equal_steps(const Node& node)
{
  const TableReader table(node, {"from", "to", "count"});
  const double from = to_number(table.require("from", steps_hint));
  const double to = to_number(table.require("to", steps_hint));
  const long count = to_integer_in(table.require("count", steps_hint), 2, 1'000'000,
                                   "how many values, both ends included, such as 11");
  std::vector<double> steps;
  for (long i = 0; i < count; ++i)
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

/// "crest.x", "base.opening", "base.cmod"; names of boundaries may have dots.
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

/// `until` has to be there unless something else ends the stage.
adapt::DisplacementStage to_displacement(const Node& node, bool needs_end)
{
  const TableReader table(node, {"displacement", "step", "until"});
  adapt::DisplacementStage stage;
  stage.gauges = to_gauges(table.require("displacement", gauge_hint));
  const Node& step = table.require("step", "by how much it grows in a load step, such as 1e-3");
  stage.step = to_number(step);
  if (stage.step == 0)
    throw InputError(step.where, "is 0", "by how much it grows in a load step, such as 1e-3");
  if (stage.step < 0) stage.until *= -1;
  if (needs_end) (void)table.require("until", "the value at which the path ends");
  table.read("until", stage.until, to_number);
  return stage;
}

void read_control(const Node& node, adapt::PathProgram& program)
{
  if (!node.is_table())
  {
    program.following = one_of<adapt::Following>({"load", "auto", "damage"})(node);
    return;
  }
  program.following = adapt::Following::displacement;
  program.displacement = to_displacement(node, false);
}

void read_stop(const Node& node, adapt::PathProgram& program)
{
  const TableReader table(node, {"damage", "t_min", "steps"});
  table.read("damage", program.enough_damage,
             [](const Node& value)
             {
               return to_number_in(value, {.lower = 0.0, .upper = 1.0, .includes_upper = true},
                                   "the mean damage of all interfaces, such as 0.95");
             });
  if (const Node* t_min = table.find("t_min")) program.t_min = to_number(*t_min);
  table.read("steps", program.max_steps, integer_from(1, "a number of load steps, such as 100"));
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

constexpr std::array<std::string_view, 8> history_keys = {"steps", "control", "damage_step", "stop",
                                                          "then",  "watch",   "refine",      "check"};

HistoryConfig read_history(const Node& node)
{
  const TableReader table(node, history_keys);
  HistoryConfig history{.where = node.where};
  adapt::PathProgram& program = history.program;
  read_steps(table.require("steps", steps_hint), program.targets);
  if (const Node* control = table.find("control")) read_control(*control, program);
  if (const Node* step = table.find("damage_step"))
    program.damage_step =
        to_number_in(*step, positive, "length or area that is damaged anew in a load step, such as 0.5");
  if (const Node* stop = table.find("stop")) read_stop(*stop, program);
  if (const Node* then = table.find("then")) program.then = to_displacement(*then, true);
  table.read("watch", history.watch, read_watch);
  table.read("refine", history.refine, one_of<Refine>({"replay", "transfer", "none"}));
  table.read("check", history.check, to_bool);
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

/// Whether any contact of the case is so.
bool any_contact(const Config& config, bool (*is_so)(const std::optional<problem::Contact>&))
{
  return std::ranges::any_of(config.boundaries, is_so, &BoundaryConfig::contact) ||
         std::ranges::any_of(config.contacts, is_so, &ContactConfig::contact);
}

/// Throws where the path cannot be followed beyond its values of t as the table says.
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
    refuse("control", "goes by damage, and no interface can be damaged",
           "an interface with a bond, or \"load\"");
  if (by_damage && any_contact(config, is_endo))
    refuse("control", "goes by damage, which law = \"endo\" does not offer",
           "{ displacement = ..., step = ... }");
  if (!by_damage) refuse("damage_step", "goes with control by damage", "control = \"auto\" or \"damage\"");
  if (program.following != adapt::Following::load)
  {
    if (std::ranges::adjacent_find(program.targets, std::ranges::not_equal_to()) == program.targets.end())
      refuse("steps", "is too short: beyond it the path is extrapolated from two steps",
             "one more value of t");
    return;
  }
  constexpr auto hint = "control = \"auto\", \"damage\" or { displacement = ..., step = ... }";
  refuse("stop", "is for paths that go on after the values of t", hint);
  refuse("then", "is for paths that go on after the values of t", hint);
}

}  // namespace

void read_load_steps(const TableReader& root, Config& config)
{
  root.read("history", config.history, read_history);
  if (!config.history && any_contact(config, remembers)) config.history.emplace();
  // What a step leaves to the next ones is not in their bounds: all of it is solved for.
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
  if (const Node* history = root.find("history")) check_control(TableReader(*history, history_keys), config);
}

}  // namespace tribound::case_file
