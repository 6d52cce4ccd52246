#include "tribound/case/deck/deck_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tribound::case_file
{

namespace
{

/// Output, tables of other analyses, and what only names or orders things.
constexpr std::string_view without_effect =
    "|NODE FILE|EL FILE|EL PRINT|ELEMENT OUTPUT|NODE OUTPUT|CONTACT FILE|CONTACT PRINT|"
    "CONTACT OUTPUT|SECTION PRINT|FACE PRINT|OUTPUT|ENERGY OUTPUT|ENERGY PRINT|ENERGY FILE|PREPRINT|"
    "MONITOR|RESTART|TIME POINTS|FILE FORMAT|FILTER|PRINT|CONTROLS|CONTACT CONTROLS|"
    "SOLUTION TECHNIQUE|ASSEMBLY|END ASSEMBLY|END INSTANCE|CONDUCTIVITY|SPECIFIC HEAT|ORIENTATION|"
    "PHYSICAL CONSTANTS|DEPVAR|SECTION CONTROLS|CONTACT DAMPING|";

constexpr std::string_view other_analyses =
    "|DYNAMIC|FREQUENCY|BUCKLE|HEAT TRANSFER|COUPLED TEMPERATURE-DISPLACEMENT|"
    "UNCOUPLED TEMPERATURE-DISPLACEMENT|VISCO|MODAL DYNAMIC|STEADY STATE DYNAMICS|ELECTROMAGNETICS|"
    "CFD|GREEN|SUBSTRUCTURE GENERATE|SENSITIVITY|COMPLEX FREQUENCY|CRACK PROPAGATION|MASS FLOW|";

bool is_among(const std::string& keyword, std::string_view names)
{
  return names.find("|" + keyword + "|") != std::string_view::npos;
}

}  // namespace

namespace
{

/// The parameters that are dealt with, or change nothing; keywords that are not here may have any.
const std::map<std::string_view, std::string_view>& known_parameters()
{
  static const std::map<std::string_view, std::string_view> table = {
      {"ELASTIC", "|TYPE|"},
      {"EXPANSION", "|TYPE|ZERO|"},
      {"DENSITY", "|"},
      {"SURFACE INTERACTION", "|NAME|"},
      {"SURFACE BEHAVIOR", "|PRESSURE-OVERCLOSURE|"},
      {"FRICTION", "|"},
      {"CONTACT PAIR", "|INTERACTION|TYPE|ADJUST|SMALLSLIDING|"},
      {"TIE", "|NAME|POSITIONTOLERANCE|ADJUST|TYPE|"},
      {"CLEARANCE", "|MASTER|SLAVE|VALUE|"},
      {"INITIAL CONDITIONS", "|TYPE|"},
      {"AMPLITUDE", "|NAME|TIME|SHIFTX|SHIFTY|DEFINITION|"},
      {"STEP", "|NAME|INC|NLGEOM|AMPLITUDE|PERTURBATION|UNSYMM|"},
      {"STATIC", "|SOLVER|DIRECT|RIKS|"},
      {"BOUNDARY", "|OP|AMPLITUDE|TYPE|"},
      {"CLOAD", "|OP|AMPLITUDE|"},
      {"DLOAD", "|OP|AMPLITUDE|"},
      {"DSLOAD", "|OP|AMPLITUDE|"},
      {"TEMPERATURE", "|OP|AMPLITUDE|"},
      {"RIGID BODY", "|NSET|ELSET|REFNODE|ROTNODE|"},
      {"COUPLING", "|REFNODE|SURFACE|CONSTRAINTNAME|ORIENTATION|"},
      {"KINEMATIC", "|"}};
  return table;
}

}  // namespace

void DeckReader::check_parameters(const Block& block)
{
  const auto known = known_parameters().find(block.keyword.name);
  if (known == known_parameters().end()) return;
  for (const auto& [name, value] : block.keyword.parameters)
    if (!is_among(name, known->second))
      log_.drop(block.keyword.place, block.keyword.name,
                fmt::format("the parameter {}{} has no counterpart here, and may change the answer", name,
                            value.empty() ? "" : "=" + value));
}

const std::map<std::string_view, DeckReader::Handler>& DeckReader::handlers()
{
  static const std::map<std::string_view, Handler> table = {
      {"HEADING", &DeckReader::read_heading},
      {"MATERIAL", &DeckReader::read_material},
      {"ELASTIC", &DeckReader::read_elastic},
      {"EXPANSION", &DeckReader::read_expansion},
      {"DENSITY", &DeckReader::read_density},
      {"SURFACE INTERACTION", &DeckReader::read_interaction},
      {"SURFACE BEHAVIOR", &DeckReader::read_behaviour},
      {"FRICTION", &DeckReader::read_friction},
      {"CONTACT PAIR", &DeckReader::read_contact_pair},
      {"TIE", &DeckReader::read_tie},
      {"CLEARANCE", &DeckReader::read_clearance},
      {"INITIAL CONDITIONS", &DeckReader::read_initial_conditions},
      {"AMPLITUDE", &DeckReader::read_amplitude},
      {"RIGID BODY", &DeckReader::read_rigid_body},
      {"COUPLING", &DeckReader::read_coupling},
      {"DISTRIBUTING", &DeckReader::read_distributing},
      {"KINEMATIC", &DeckReader::read_kinematic},
      {"NODE PRINT", &DeckReader::read_node_print},
      {"STEP", &DeckReader::begin_step},
      {"STATIC", &DeckReader::read_static},
      {"END STEP", &DeckReader::end_step},
      {"BOUNDARY", &DeckReader::read_boundary},
      {"CLOAD", &DeckReader::read_nodal_forces},
      {"DLOAD", &DeckReader::read_element_loads},
      {"DSLOAD", &DeckReader::read_surface_loads},
      {"TEMPERATURE", &DeckReader::read_temperature}};
  return table;
}

Deck DeckReader::read()
{
  for (const Block& block : assembler_.model().blocks)
  {
    const std::string& name = block.keyword.name;
    const auto handler = handlers().find(name);
    if (handler != handlers().end())
    {
      check_parameters(block);
      (this->*handler->second)(block);
    }
    else if (is_among(name, without_effect))
      pass_over(block);
    else if (is_among(name, other_analyses))
      refuse(block);
    else
      drop(block);
  }
  if (coupling_ != nullptr) drop(*coupling_);
  if (in_step_)
    log_.refuse(deck_.steps.back().place, "STEP", "the step has no *END STEP", "is the deck complete?");
  if (deck_.steps.empty())
    throw InputError({.file = assembler_.mesh().source.file}, "the deck has no *STEP with *STATIC",
                     "a deck without loads is a mesh: [mesh] file = \"....inp\"");
  return std::move(deck_);
}

double DeckReader::number(const Line& line, std::size_t field, double missing) const
{
  if (field >= line.fields.size() || line.fields[field].empty()) return missing;
  return assembler_.lines().number(line.fields[field], line.place);
}

const std::string& DeckReader::field(const Line& line, std::size_t field) const
{
  static const std::string empty;
  return field < line.fields.size() ? line.fields[field] : empty;
}

std::string DeckReader::line_name(const Line& line) const
{
  return fmt::format("line {}", assembler_.lines().where(line.place).line);
}

void DeckReader::pass_over(const Block& block)
{
  const std::string& name = block.keyword.name;
  if (name == "NODE PRINT" || name == "SECTION PRINT" || name == "CONTACT PRINT")
    return log_.add(block.keyword.place, name, Fate::left_out,
                    "the certificate has the reactions of all supports, and contact forces as quantities");
  log_.add(block.keyword.place, block.keyword.name, Fate::left_out, "nothing in the answer depends on it");
}

void DeckReader::drop(const Block& block)
{
  log_.drop(block.keyword.place, block.keyword.name, "has no counterpart here, and may change the answer");
}

void DeckReader::refuse(const Block& block)
{
  log_.refuse(block.keyword.place, block.keyword.name, "only static steps can be imported",
              "take out the step, or write a deck with *STATIC");
}

void DeckReader::read_heading(const Block& block)
{
  if (block.lines.empty() || !deck_.title.empty()) return;
  deck_.title = printable(fmt::format("{}", fmt::join(block.lines[0].fields, ", ")));
  take(block, "the title");
}

void DeckReader::read_material(const Block& block)
{
  deck_.materials.push_back({required(block, "NAME")});
  take(block, deck_.materials.back().name);
}

void DeckReader::read_elastic(const Block& block)
{
  if (deck_.materials.empty() || block.lines.empty()) return drop(block);
  const std::string type = mesh::capitals(block.keyword.find("TYPE").value_or("ISO"));
  if (type != "ISO" && type != "ISOTROPIC")
    return log_.refuse(block.keyword.place, "ELASTIC",
                       fmt::format("materials of type {} are not isotropic", type),
                       "E and nu of an isotropic material");
  DeckMaterial& material = deck_.materials.back();
  const Line& line = block.lines[0];
  material.E = number(line, 0);
  material.nu = number(line, 1);
  for (const Line& other : block.lines)
    if (number(other, 0) != *material.E || number(other, 1) != *material.nu)
      return log_.drop(block.keyword.place, "ELASTIC",
                       fmt::format("E and nu of {} do not depend on the temperature here: those of the first "
                                   "line count",
                                   material.name));
  take(block, fmt::format("E = {}, nu = {}", *material.E, *material.nu));
}

void DeckReader::read_expansion(const Block& block)
{
  if (deck_.materials.empty() || block.lines.empty()) return drop(block);
  if (const std::string type = mesh::capitals(block.keyword.find("TYPE").value_or("ISO")); type != "ISO")
    return log_.refuse(block.keyword.place, "EXPANSION",
                       fmt::format("an expansion of type {} is not isotropic", type));
  DeckMaterial& material = deck_.materials.back();
  material.alpha = number(block.lines[0], 0);
  for (const Line& other : block.lines)
    if (number(other, 0) != *material.alpha)
      return log_.drop(block.keyword.place, "EXPANSION",
                       fmt::format("the expansion of {} does not depend on the temperature here: that of the "
                                   "first line counts",
                                   material.name));
  take(block, fmt::format("alpha = {}", *material.alpha));
}

void DeckReader::read_density(const Block& block)
{
  if (deck_.materials.empty() || block.lines.empty()) return drop(block);
  deck_.materials.back().density = number(block.lines[0], 0);
  take(block, "for *DLOAD with GRAV and CENTRIF");
}

void DeckReader::read_interaction(const Block& block)
{
  deck_.interactions.push_back({required(block, "NAME")});
  take(block, deck_.interactions.back().name);
}

void DeckReader::read_behaviour(const Block& block)
{
  if (deck_.interactions.empty()) return drop(block);
  const std::string law = mesh::capitals(block.keyword.find("PRESSURE-OVERCLOSURE").value_or("HARD"));
  if (law == "TIED")
  {
    deck_.interactions.back().is_tied = true;
    return log_.add(block.keyword.place, block.keyword.name, Fate::changed,
                    "the surfaces are tied; the stiffness of the tie is dropped");
  }
  if (law == "HARD") return take(block, "contact is rigid: no surface penetrates another");
  log_.add(block.keyword.place, block.keyword.name, Fate::changed,
           fmt::format("contact is rigid: no surface penetrates another; the stiffness ({}) is dropped{}",
                       law, law == "EXPONENTIAL" ? ", whose pressure begins before the surfaces touch" : ""));
}

void DeckReader::read_friction(const Block& block)
{
  if (deck_.interactions.empty() || in_step_ || block.lines.size() > 1) return drop(block);
  if (block.lines.empty()) return;
  const double coefficient = number(block.lines[0], 0);
  if (!(coefficient >= 0))
    return log_.refuse(block.lines[0].place, "FRICTION",
                       fmt::format("the coefficient {} is negative", coefficient));
  deck_.interactions.back().coefficient = coefficient;
  const std::string text = fmt::format("Coulomb, coefficient {}", coefficient);
  if (block.lines[0].fields.size() > 1 && number(block.lines[0], 1) != 0)
    return log_.add(block.keyword.place, "FRICTION", Fate::changed,
                    text + "; surfaces stick rigidly: the stick slope is dropped");
  take(block, text);
}

void DeckReader::read_contact_pair(const Block& block)
{
  const std::string interaction = required(block, "INTERACTION");
  const std::string type = mesh::capitals(block.keyword.find("TYPE").value_or(""));
  std::optional<double> adjust;
  if (const auto given = block.keyword.find("ADJUST"))
  {
    adjust = mesh::number_of(*given);
    if (!adjust)
      log_.drop(block.keyword.place, "CONTACT PAIR",
                fmt::format("ADJUST={} names a set; a distance can be read", *given));
  }
  for (const Line& line : block.lines)
  {
    if (line.fields.size() < 2)
      assembler_.lines().fail(line.place, "a contact pair is two surfaces: \"slave, master\"");
    deck_.pairs.push_back({line.place, line.fields[0], line.fields[1], interaction, type, adjust});
  }
  log_.add(block.keyword.place, block.keyword.name, Fate::changed,
           fmt::format("contact on the undeformed surfaces by Nitsche's method{}",
                       type.empty() ? "" : fmt::format(" in place of TYPE={}", type)));
}

void DeckReader::read_tie(const Block& block)
{
  DeckPair pair{block.keyword.place, {}, {}, {}};
  if (const auto tolerance = block.keyword.find("POSITIONTOLERANCE"))
    pair.tolerance = mesh::number_of(*tolerance);
  for (const Line& line : block.lines)
  {
    if (line.fields.size() < 2)
      assembler_.lines().fail(line.place, "a tie is two surfaces: \"slave, master\"");
    pair.place = line.place;
    pair.slave = line.fields[0];
    pair.master = line.fields[1];
    deck_.pairs.push_back(pair);
  }
  take(block, "tied surfaces; meshes need not match");
}

void DeckReader::read_clearance(const Block& block)
{
  const std::string slave = mesh::capitals(required(block, "SLAVE"));
  const std::string master = mesh::capitals(required(block, "MASTER"));
  const std::optional<double> value = mesh::number_of(required(block, "VALUE"));
  if (!value || !std::isfinite(*value)) assembler_.lines().fail(block.keyword.place, "VALUE is not a number");
  bool is_used = false;
  bool is_ignored = false;
  for (DeckPair& pair : deck_.pairs)
    if (mesh::capitals(pair.slave) == slave && mesh::capitals(pair.master) == master)
    {
      pair.clearance = value;
      is_used = true;
      is_ignored = pair.type.starts_with("NODE");
    }
  if (!is_used)
    return log_.refuse(block.keyword.place, "CLEARANCE",
                       fmt::format("there is no contact pair {}, {} so far", slave, master));
  log_.add(block.keyword.place, "CLEARANCE", is_ignored ? Fate::changed : Fate::taken,
           fmt::format("gap = {}{}", *value,
                       is_ignored ? "; CalculiX ignores it for pairs of TYPE=NODE TO SURFACE" : ""));
}

void DeckReader::read_amplitude(const Block& block)
{
  DeckAmplitude amplitude;
  amplitude.is_of_total_time =
      mesh::capitals(block.keyword.find("TIME").value_or("STEP TIME")).starts_with("TOTAL");
  const std::string definition = mesh::capitals(block.keyword.find("DEFINITION").value_or("TABULAR"));
  if (definition != "TABULAR")
    return log_.refuse(block.keyword.place, "AMPLITUDE", "only tables can be imported",
                       "pairs of time and value: \"0, 0, 1, 1\"");
  std::vector<double> values;
  for (const Line& line : block.lines)
    for (std::size_t i = 0; i < line.fields.size(); ++i) values.push_back(number(line, i));
  if (values.size() < 2 || values.size() % 2 != 0)
    assembler_.lines().fail(block.keyword.place, "an amplitude is pairs of time and value");
  const auto shift = [&](std::string_view name)
  {
    const std::optional<double> value = mesh::number_of(block.keyword.find(name).value_or("0"));
    if (!value) assembler_.lines().fail(block.keyword.place, fmt::format("{} is not a number", name));
    return *value;
  };
  for (std::size_t i = 0; i < values.size(); i += 2)
  {
    amplitude.points.push_back({values[i] + shift("SHIFTX"), values[i + 1] + shift("SHIFTY")});
    if (i > 0 && (!(values[i] > values[i - 2]) ||
                  !std::isfinite((values[i + 1] - values[i - 1]) / (values[i] - values[i - 2]))))
      assembler_.lines().fail(block.keyword.place, "the times of an amplitude must increase");
  }
  deck_.amplitudes[mesh::capitals(required(block, "NAME"))] = std::move(amplitude);
  take(block, fmt::format("{} points", values.size() / 2));
}

void DeckReader::read_node_print(const Block& block)
{
  bool has_displacements = false;
  for (const Line& line : block.lines)
    for (const std::string& variable : line.fields)
      has_displacements = has_displacements || mesh::capitals(variable) == "U";
  const auto set = block.keyword.find("NSET");
  if (!has_displacements || !set) return pass_over(block);
  deck_.displacements_of_nodes.push_back({block.keyword.place, *set});
}

double DeckAmplitude::at(double t) const
{
  const auto after = std::ranges::upper_bound(points, t, {}, &Course::Point::t);
  if (after == points.begin()) return points.front().value;
  if (after == points.end()) return points.back().value;
  const Course::Point& a = *(after - 1);
  return a.value + (after->value - a.value) * (t - a.t) / (after->t - a.t);
}

}  // namespace tribound::case_file
