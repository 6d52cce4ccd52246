#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "tribound/base/sorted.h"
#include "tribound/case/deck/deck_reader.h"

namespace tribound::case_file
{

namespace
{

/// Values that replace each other, and are not added up.
bool is_state(DeckLoadKind kind)
{
  return kind == DeckLoadKind::displacement || kind == DeckLoadKind::rigid_motion ||
         kind == DeckLoadKind::temperature;
}

}  // namespace

void DeckReader::begin_step(const Block& block)
{
  if (in_step_) log_.refuse(block.keyword.place, "STEP", "the step before has no *END STEP");
  in_step_ = true;
  renewed_.clear();
  cards_.clear();
  // What stands before the first step belongs to it.
  if (!deck_.steps.empty())
    for (DeckLoad& load : deck_.loads) load.is_in_step = false;
  if (const auto nlgeom = block.keyword.find("NLGEOM"); nlgeom && mesh::capitals(*nlgeom) != "NO")
    log_.drop(block.keyword.place, "NLGEOM",
              "strains and rotations are small, the surfaces stay as they are");
  if (mesh::capitals(block.keyword.find("AMPLITUDE").value_or("RAMP")) != "RAMP")
    log_.drop(block.keyword.place, "STEP", "loads grow evenly over the step, not at once");
  if (block.keyword.find("PERTURBATION"))
    log_.refuse(block.keyword.place, "STEP", "perturbation steps cannot be imported");
  const double begin = deck_.steps.empty() ? 0.0 : deck_.steps.back().end;
  deck_.steps.push_back({block.keyword.place, begin, begin, 0});
  take(block, fmt::format("load step {}", deck_.steps.size()));
}

void DeckReader::read_static(const Block& block)
{
  if (!in_step_ || block.keyword.find("RIKS")) return refuse(block);
  DeckStep& step = deck_.steps.back();
  double period = 1;
  step.increment = 1;
  if (!block.lines.empty())
  {
    const Line& line = block.lines[0];
    step.increment = number(line, 0, 1);
    period = number(line, 1, 1);
    if (!(period > 0) || !(step.increment > 0))
      assembler_.lines().fail(line.place, "increment and period of a step are positive: \"0.1, 1\"");
  }
  step.end = step.begin + period;
  take(block, fmt::format("t from {} to {}", step.begin, step.end));
}

void DeckReader::end_step(const Block& /*block*/)
{
  if (!in_step_) return;
  in_step_ = false;
  const DeckStep& step = deck_.steps.back();
  if (!(step.end > step.begin))
    return log_.refuse(step.place, "STEP", "the step has no *STATIC", "only static steps can be imported");
  for (DeckLoad& load : deck_.loads)
  {
    if (load.is_active && !load.is_in_step && renewed_.contains(load.kind)) end_load(load, step);
    follow(load);
  }
}

void DeckReader::end_load(DeckLoad& load, const DeckStep& step)
{
  if (is_state(load.kind))
    log_.refuse(step.place, load.kind == DeckLoadKind::temperature ? "TEMPERATURE" : "BOUNDARY",
                fmt::format("OP=NEW ends that of {} in this step; in a case it stays", load.target),
                "import the steps before and after as two decks");
  load.is_active = false;
  load.is_in_step = true;
  load.amplitude.clear();
  load.magnitude = 0;
}

DeckLoad& DeckReader::load_on(DeckLoadKind kind, const Block& block, const mesh::InpPlace& place,
                              const std::string& target, std::vector<Index> members, int component,
                              std::vector<double> data)
{
  const bool adds_up = !is_state(kind);
  const LoadKey key = {kind, component, members.size(), members.at(0)};
  const auto [begin, end] = places_of_loads_.equal_range(key);
  for (auto same = begin; same != end; ++same)
    if (DeckLoad& load = deck_.loads[same->second];
        load.is_active && load.members == members && load.data == data)
      return load;
  for (const DeckLoad& load : deck_.loads)
  {
    if (!adds_up || load.kind != kind || load.component != component || load.data != data ||
        !load.is_active || load.is_in_step)
      continue;
    std::vector<Index> common;
    std::ranges::set_intersection(load.members, members, std::back_inserter(common));
    if (!common.empty())
      log_.refuse(place, block.keyword.name,
                  fmt::format("{} replaces a part of the load on {} of an earlier step", target, load.target),
                  "loads of a later step on the same sets, or on sets without common members");
  }
  if (!adds_up && deck_.steps.size() > 1)
    log_.refuse(place, block.keyword.name,
                fmt::format("{} is free up to this step, and is then given: a case has the same supports and "
                            "temperatures in all steps",
                            target),
                "give it in the first step, too");
  places_of_loads_.emplace(key, deck_.loads.size());
  deck_.loads.push_back({kind, place, target, std::move(members), component, std::move(data)});
  return deck_.loads.back();
}

void DeckReader::apply(DeckLoad& load, double value, const Block& block)
{
  const std::string amplitude = mesh::capitals(block.keyword.find("AMPLITUDE").value_or(""));
  if (!amplitude.empty() && !deck_.amplitudes.contains(amplitude))
    assembler_.lines().fail(block.keyword.place,
                            fmt::format("there is no amplitude \"{}\" so far", amplitude),
                            "*AMPLITUDE, NAME=... stands before what uses it");
  const bool is_more = !is_state(load.kind) && load.is_in_step;
  if (is_more && amplitude != load.amplitude)
    log_.refuse(block.keyword.place, block.keyword.name,
                fmt::format("{} has this load twice in a step, with different amplitudes", load.target));
  if (!in_step_ && (!deck_.steps.empty() || !is_state(load.kind)))
    log_.refuse(block.keyword.place, block.keyword.name, "stands outside of the steps", "put it into a step");
  load.magnitude = is_more ? load.magnitude + value : value;
  load.amplitude = amplitude;
  load.is_in_step = true;
}

/// Loads without amplitude change evenly over the step. An amplitude of the time in the step counts in the
/// step that names it alone.
void DeckReader::follow(DeckLoad& load) const
{
  const DeckStep& step = deck_.steps.back();
  const DeckAmplitude* amplitude = load.amplitude.empty() ? nullptr : &deck_.amplitudes.at(load.amplitude);
  if (load.course.points().empty()) load.course.add(step.begin, 0);
  load.course.add(step.begin, load.course.last());
  if (amplitude == nullptr || (!amplitude->is_of_total_time && !load.is_in_step))
  {
    load.course.add(step.end, amplitude == nullptr ? load.magnitude : load.course.last());
    return;
  }
  const double offset = amplitude->is_of_total_time ? 0.0 : step.begin;
  load.course.add(step.begin, load.magnitude * amplitude->at(step.begin - offset));
  for (const Course::Point& p : amplitude->points)
    if (p.t + offset > step.begin && p.t + offset < step.end)
      load.course.add(p.t + offset, load.magnitude * p.value);
  load.course.add(step.end, load.magnitude * amplitude->at(step.end - offset));
}

/// The first keyword of its name in a step decides.
void DeckReader::note_new(const Block& block, std::span<const DeckLoadKind> kinds)
{
  const std::string list = block.keyword.name == "DSLOAD" ? "DLOAD" : block.keyword.name;
  const bool is_new = mesh::capitals(block.keyword.find("OP").value_or("MOD")) == "NEW";
  if (!cards_.insert(list).second || !is_new || !in_step_) return;
  renewed_.insert(kinds.begin(), kinds.end());
  for (DeckLoad& load : deck_.loads)
    if (std::ranges::count(kinds, load.kind) > 0) load.is_in_step = false;
}

void DeckReader::read_boundary(const Block& block)
{
  note_new(block, std::array{DeckLoadKind::displacement, DeckLoadKind::rigid_motion});
  if (mesh::capitals(block.keyword.find("TYPE").value_or("DISPLACEMENT")) != "DISPLACEMENT")
    return log_.refuse(block.keyword.place, "BOUNDARY", "velocities and accelerations cannot be imported");
  // Nodes given one by one are taken together where the rest of their lines agrees.
  std::map<std::vector<std::string>, std::pair<const Line*, std::vector<Index>>> singles;
  for (const Line& line : block.lines)
  {
    if (line.fields.size() < 2)
      assembler_.lines().fail(line.place, "a line of *BOUNDARY: set or node, first component, last, value");
    const std::vector<Index> nodes = assembler_.nodes_named(line.fields[0], line.place);
    if (apply_to_rigid(block, line, nodes)) continue;
    if (!mesh::integer_of(line.fields[0]))
    {
      fix(block, line, line.fields[0], nodes);
      continue;
    }
    auto& [first, pooled] = singles[{line.fields.begin() + 1, line.fields.end()}];
    if (first == nullptr) first = &line;
    pooled.insert(pooled.end(), nodes.begin(), nodes.end());
  }
  for (auto& [_, single] : singles)
  {
    sort_and_unite(single.second);
    fix(block, *single.first, line_name(*single.first), single.second);
  }
  take(block, "displacements");
}

void DeckReader::fix(const Block& block, const Line& line, const std::string& target,
                     const std::vector<Index>& nodes)
{
  static const std::map<std::string, std::vector<int>> words = {
      {"ENCASTRE", {0, 1, 2}}, {"PINNED", {0, 1, 2}}, {"XSYMM", {0}}, {"YSYMM", {1}}, {"ZSYMM", {2}}};
  const auto word = words.find(mesh::capitals(line.fields[1]));
  if (word == words.end()) return fix_components(block, line, target, nodes);
  for (const int component : word->second)
    if (component < faces_.dim())
      apply(load_on(DeckLoadKind::displacement, block, line.place, target, nodes, component), 0, block);
}

void DeckReader::fix_components(const Block& block, const Line& line, const std::string& target,
                                const std::vector<Index>& nodes)
{
  const auto component = [&](std::size_t i)
  {
    const std::optional<std::int64_t> value = mesh::integer_of(field(line, i));
    if (!value || *value < 1 || *value > 6)
      assembler_.lines().fail(line.place,
                              fmt::format("\"{}\" is no component of a displacement", field(line, i)),
                              "1 to 3; 4 to 6 are rotations, which solids do not have");
    return static_cast<int>(*value);
  };
  const int first = component(1);
  const int last = field(line, 2).empty() ? first : component(2);
  if (last < first)
    assembler_.lines().fail(line.place, fmt::format("the components {} to {} are none", first, last));
  if (faces_.dim() == 2 && first <= 3 && last >= 3 && number(line, 3) != 0)
    assembler_.lines().fail(line.place, "component 3 of a plane deck is given, and not 0");
  for (int c = first; c <= std::min(last, faces_.dim()); ++c)
    apply(load_on(DeckLoadKind::displacement, block, line.place, target, nodes, c - 1), number(line, 3),
          block);
}

}  // namespace tribound::case_file
