#include "tribound/io/state/path_checkpoint.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/fem/nested.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/record_json.h"

namespace tribound::io
{

namespace
{

constexpr int n_components = static_cast<int>(certify::all_components.size());

/// Numbers per contact point: boundary, position, D, q, w.
constexpr int point_width(int dim)
{
  return 2 * dim + 3;
}

template <class T>
Json or_null(const std::optional<T>& value)
{
  return value ? Json(*value) : Json(nullptr);
}

template <class T>
std::optional<T> optional_of(const Json& json)
{
  return json.is_null() ? std::nullopt : std::optional(json.get<T>());
}

Json bound_json(const certify::Bound& bound)
{
  Json json{{"total", bound.total}, {"total_sharp", bound.total_sharp}};
  for (const certify::Component& c : certify::all_components) json[c.name] = bound.global.*c.value;
  return json;
}

certify::Bound bound_of(const Json& json)
{
  certify::Bound bound{{}, json.at("total"), json.at("total_sharp")};
  for (const certify::Component& c : certify::all_components) bound.global.*c.value = json.at(c.name);
  return bound;
}

adapt::PathEnd path_end_of(const Json& json)
{
  adapt::PathEnd end{.dropped = json.at("dropped"), .notes = json.at("notes")};
  if (const Json& peak = json.at("peak"); !peak.is_null())
    end.peak = adapt::Peak{peak.at("t"), peak.at("step"), optional_of<double>(peak.at("change")),
                           peak.at("increment")};
  return end;
}

template <int dim>
Json progress_json(const adapt::PathProgress<dim>& progress)
{
  return {{"target", progress.target},
          {"load", {progress.load.whole, progress.load.size, progress.load.cuts}},
          {"failed", or_null(progress.failed)},
          {"direction", progress.direction},
          {"stage", static_cast<int>(progress.stage)},
          {"steps", progress.steps},
          {"size", or_null(progress.size)},
          {"last_increment", progress.last_increment},
          {"cuts", progress.cuts},
          {"end", path_json(progress.end)}};
}

template <int dim>
adapt::PathProgress<dim> progress_of(const Json& json)
{
  const Json& load = json.at("load");
  return {.target = json.at("target"),
          .load = {load.at(0), load.at(1), load.at(2)},
          .failed = optional_of<double>(json.at("failed")),
          .direction = json.at("direction"),
          .stage = static_cast<adapt::PathStage>(json.at("stage").get<int>()),
          .steps = json.at("steps"),
          .size = optional_of<double>(json.at("size")),
          .last_increment = json.at("last_increment"),
          .cuts = json.at("cuts"),
          .end = path_end_of(json.at("end"))};
}

template <int dim>
Json step_json(const adapt::SavedStep<dim>& step, std::int64_t n_points)
{
  return {{"number", step.number},
          {"t", step.t},
          {"control", step.control},
          {"reference_force", step.reference_force},
          {"largest_sigma", step.largest_sigma},
          {"tips", step.tips},
          {"points", n_points}};
}

template <int dim>
void append(const adapt::GatheredHistory<dim>& history, std::vector<double>& points)
{
  for (const auto& [tag, x, state] : history.states)
  {
    points.push_back(tag);
    points.insert(points.end(), x.begin(), x.end());
    points.insert(points.end(), {state.damage, state.slipped});
    points.insert(points.end(), state.slip.begin(), state.slip.end());
  }
}

template <int dim>
adapt::GatheredHistory<dim> history_of(std::span<const double> points)
{
  constexpr std::size_t width = point_width(dim);
  adapt::GatheredHistory<dim> history;
  for (; points.size() >= width; points = points.subspan(width))
    history.states.push_back({static_cast<int>(points[0]),
                              Point<dim>(&points[1]),
                              {points[dim + 1], points[dim + 2], Point<dim>(&points[dim + 3])}});
  return history;
}

/// The functions of the space, and the components on own cells, by number of the cell.
template <int dim>
struct Fields
{
  std::vector<std::vector<double>> functions;
  std::vector<certify::BoundComponents> components;
};

template <int dim>
Fields<dim> fields_of(const fem::LagrangeSpace<dim>& space, std::span<const Index> cells,
                      std::span<const double> values, int n_functions)
{
  const std::size_t n = static_cast<std::size_t>(dim) * space.basis().n_nodes();
  const std::size_t width = n * n_functions + n_components;
  Fields<dim> fields;
  for (int k = 0; k < n_functions; ++k)
    fields.functions.push_back(
        fem::from_cell_values<dim>(space, cells, fem::cell_column(values, width, k * n, n)));
  fields.components.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int i = 0; i < n_components; ++i)
      fields.components[cells[c]].*certify::all_components[i].value = values[c * width + n * n_functions + i];
  return fields;
}

template <int dim>
adapt::ReplayState<dim> state_of(const CheckpointFacts& facts, const fem::LagrangeSpace<dim>& space,
                                 std::span<const Index> cells, std::span<const double> values,
                                 std::span<const double> points)
{
  const Json json = Json::parse(facts.path);
  adapt::ReplayState<dim> state;
  state.pass = facts.start.level;
  state.friedrichs = facts.start.friedrichs;
  state.progress = progress_of<dim>(json.at("progress"));
  state.worst = bound_of(json.at("worst"));
  state.worst_step = json.at("worst_step");
  state.verdict = {static_cast<certify::RunStatus>(json.at("status").get<int>()), json.at("reason")};
  Fields<dim> fields = fields_of<dim>(space, cells, values, facts.n_functions);
  state.cells = std::move(fields.components);
  std::size_t k = 0;
  for (const Json& step : json.at("steps"))
  {
    const std::size_t n = step.at("points").get<std::size_t>() * point_width(dim);
    if (n > points.size()) throw std::out_of_range("contact points are missing");
    state.path.steps.push_back({.number = step.at("number"),
                                .t = step.at("t"),
                                .control = step.at("control"),
                                .reference_force = step.at("reference_force"),
                                .largest_sigma = step.at("largest_sigma"),
                                .tips = step.at("tips"),
                                .u = std::move(fields.functions.at(k++)),
                                .history = history_of<dim>(points.first(n))});
    points = points.subspan(n);
  }
  if (!json.at("before").is_null())
    state.path.before = {json.at("before"), std::move(fields.functions.at(k))};
  return state;
}

}  // namespace

template <int dim>
CheckpointFields to_checkpoint(const adapt::ReplayState<dim>& state, CheckpointFacts& facts)
{
  CheckpointFields fields{.point_width = point_width(dim)};
  Json steps = Json::array();
  for (const adapt::SavedStep<dim>& step : state.path.steps)
  {
    fields.functions.emplace_back(step.u);
    steps.push_back(step_json(step, static_cast<std::int64_t>(step.history.states.size())));
    append(step.history, fields.points);
  }
  const adapt::PathPoint& before = state.path.before;
  if (!before.u.empty()) fields.functions.emplace_back(before.u);
  for (const certify::BoundComponents& cell : state.cells)
    for (const certify::Component& c : certify::all_components) fields.cell_values.push_back(cell.*c.value);
  facts.start.level = state.pass;
  facts.start.friedrichs = state.friedrichs;
  facts.n_functions = static_cast<int>(fields.functions.size());
  facts.n_cell_values = n_components;
  facts.path = Json{{"progress", progress_json(state.progress)},
                    {"steps", steps},
                    {"before", before.u.empty() ? Json(nullptr) : Json(before.t)},
                    {"worst", bound_json(state.worst)},
                    {"worst_step", state.worst_step},
                    {"status", static_cast<int>(state.verdict.status)},
                    {"reason", state.verdict.reason}}
                   .dump();
  return fields;
}

template <int dim>
adapt::ReplayState<dim> from_checkpoint(const CheckpointFacts& facts, const fem::LagrangeSpace<dim>& space,
                                        std::span<const Index> cells, std::span<const double> values,
                                        std::span<const double> points)
{
  const auto damaged = [](const char* why)
  { return InputError({}, std::string("the checkpoint is damaged: ") + why, "start the run anew"); };
  try
  {
    return state_of<dim>(facts, space, cells, values, points);
  }
  catch (const Json::exception& error)
  {
    throw damaged(error.what());
  }
  catch (const std::out_of_range& error)
  {
    throw damaged(error.what());
  }
}

template CheckpointFields to_checkpoint(const adapt::ReplayState<2>&, CheckpointFacts&);
template CheckpointFields to_checkpoint(const adapt::ReplayState<3>&, CheckpointFacts&);
template adapt::ReplayState<2> from_checkpoint(const CheckpointFacts&, const fem::LagrangeSpace<2>&,
                                               std::span<const Index>, std::span<const double>,
                                               std::span<const double>);
template adapt::ReplayState<3> from_checkpoint(const CheckpointFacts&, const fem::LagrangeSpace<3>&,
                                               std::span<const Index>, std::span<const double>,
                                               std::span<const double>);

}  // namespace tribound::io
