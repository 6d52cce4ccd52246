#include "tribound/io/record/record_json.h"

#include "tribound/base/sha256.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/level_json.h"

namespace tribound::io
{

namespace
{

constexpr const char* certificate_schema = "1";

/// Times before the first level, and of the stages summed over all levels, as factorisations are.
Json times_json(const RunRecord& run)
{
  StageTimes sum;
  int factorisations = 0;
  for (const LevelRecord& level : run.levels)
  {
    sum += level.times.stages;
    factorisations += level.times.factorisations;
  }
  Json object{{"setup", run.setup}};
  object.update(stages_json(sum));
  object["factorisations"] = factorisations;
  return object;
}

/// The results of the last load step before a restart, taken from its text.
void add_results(Json& object, const std::string& earlier_steps)
{
  Json last = Json::parse(earlier_steps).back();
  LevelRecord of_step;
  of_step.load_step.emplace();
  Json not_results;
  add_load_step(not_results, of_step);
  for (const char* name : {"step", "watch", "finishing_steps", "solver", "newton", "times"})
    not_results[name] = nullptr;
  object["balance"] = last.value("balance", Json());
  for (const auto& [name, _] : not_results.items()) last.erase(name);
  object.update(last);
}

/// The levels appended to those of a text.
Json with_levels(const std::string& earlier, const std::vector<LevelRecord>& levels)
{
  Json array = Json::parse(earlier);
  for (const LevelRecord& level : levels) array.push_back(level_json(level));
  return array;
}

Json json(const doctor::Finding& warning)
{
  return {{"code", warning.code},
          {"text", warning.text},
          {"value", warning.numbers.empty() ? 0 : warning.numbers.front().second},
          {"where", text_or_null(doctor::location(warning))}};
}

template <typename Value>
Json json(const std::vector<std::pair<std::string, Value>>& named)
{
  Json object = Json::object();
  for (const auto& [name, value] : named) object[name] = value;
  return object;
}

}  // namespace

Json program_json(const BuildFacts& build)
{
  return {{"name", "tribound"},
          {"version", build.version},
          {"compiler", build.compiler},
          {"petsc", build.petsc},
          {"mumps", build.mumps},
          {"gmsh", build.gmsh},
          {"blas", build.blas},
          {"blas_threads", build.blas_threads},
          {"mpi", build.mpi},
          {"eigen", build.eigen},
          {"processes", build.processes},
          {"threads", build.threads},
          {"features", build.features}};
}

Json model_json(const CaseFacts& facts)
{
  return facts.is_axisymmetric ? Json("axisymmetric") : Json(nullptr);
}

Json units_json(const CaseFacts& facts)
{
  if (!facts.units.are_named()) return nullptr;
  Json object;
  for (const auto& [name, what] : problem::unit_names) object[name] = facts.label(what);
  object["quantities"] = Json::object();
  for (const auto& [name, unit] : facts.quantity_units) object["quantities"][name] = text_or_null(unit);
  return object;
}

Json mesh_json(const MeshFacts& mesh)
{
  Json object{
      {"vertices", mesh.vertices},         {"cells", mesh.cells},      {"smallest_cell", mesh.smallest_cell},
      {"largest_cell", mesh.largest_cell}, {"regions", Json::array()}, {"boundaries", Json::array()}};
  for (const RegionFacts& region : mesh.regions)
    object["regions"].push_back({{"name", region.name},
                                 {"cells", region.cells},
                                 {"measure", region.measure},
                                 {"material", region.material}});
  for (const BoundaryFacts& boundary : mesh.boundaries)
    object["boundaries"].push_back({{"name", boundary.name},
                                    {"facets", boundary.facets},
                                    {"measure", boundary.measure},
                                    {"condition", boundary.condition}});
  return object;
}

Json effective_case_json(const EffectiveCase& effective, const std::string& file)
{
  if (effective.text.empty()) return nullptr;
  Json object{{"file", file},
              {"sha256", sha256(effective.text)},
              {"files", Json::array()},
              {"overrides", effective.overrides}};
  for (const auto& [name, hash] : effective.files)
    object["files"].push_back({{"file", name}, {"sha256", hash}});
  return object;
}

Json path_json(const adapt::PathEnd& path)
{
  Json object{{"dropped", path.dropped}, {"notes", path.notes}, {"peak", nullptr}};
  if (path.peak)
    object["peak"] = {{"t", path.peak->t},
                      {"step", path.peak->number},
                      {"change", number_or_null(path.peak->change)},
                      {"increment", path.peak->step}};
  return object;
}

Json check_json(const RunRecord& run)
{
  const HistoryCheck& check = *run.check;
  Json object{
      {"cells", check.cells},     {"steps", check.steps}, {"failure", text_or_null(check.end.failure)},
      {"notes", check.end.notes}, {"control", nullptr},   {"compared", nullptr},
      {"note", words_of_check()}};
  const LoadStepRecord last = last_load_step(run).value_or(LoadStepRecord());
  for (const ComparedFigure& figure : compare(run.path, last, check))
    object["compared"][figure.name] = {{"path", number_or_null(figure.path)},
                                       {"check", number_or_null(figure.check)},
                                       {"difference", number_or_null(figure.difference())}};
  if (check.last) object["control"] = {{"path", last.control}, {"check", check.last->control}};
  return object;
}

Json levels_json(const RunRecord& run)
{
  return with_levels(run.earlier.levels, has_history(run) ? run.passes : run.levels);
}

Json steps_json(const RunRecord& run)
{
  return with_levels(run.earlier.steps.empty() ? "[]" : run.earlier.steps, run.levels);
}

Json certificate(const RunRecord& run)
{
  Json object{{"schema", certificate_schema},
              {"program", program_json(run.build)},
              {"title", run.facts.title},
              {"purpose", run.facts.purpose},
              {"file", run.facts.file},
              {"case", effective_case_json(run.effective, run.case_file)},
              {"status", certify::to_string(run.status)},
              {"reason", text_or_null(run.reason)},
              {"d", run.facts.dimension},
              {"model", model_json(run.facts)},
              {"p", run.facts.degree},
              {"stress", certify::to_string(run.facts.stress)},
              {"friction", run.facts.friction},
              {"gamma0", run.facts.gamma0},
              {"units", units_json(run.facts)}};
  if (!run.levels.empty()) add_results(object, run.levels.back());
  if (run.levels.empty() && !run.earlier.steps.empty()) add_results(object, run.earlier.steps);
  if (!object.contains("balance")) object["balance"] = nullptr;
  if (!run.levels.empty() && run.levels.back().balance)
    object["balance"] = balance_json(*run.levels.back().balance);
  object["tolerance"] = run.tolerance;
  object["covered"] = run.statements.covered;
  object["law"] = run.statements.law;
  object["constants"] = json(run.statements.constants);
  object["assumptions"] = json(run.statements.assumptions);
  object["not_covered"] = run.statements.not_covered;
  object["warnings"] = Json::array();
  for (const doctor::Finding& warning : run.warnings) object["warnings"].push_back(json(warning));
  object["mesh"] = mesh_json(run.mesh);
  object["levels"] = levels_json(run);
  if (has_history(run))
  {
    object["steps"] = steps_json(run);
    object["path"] = path_json(run.path);
    if (run.check) object["history_check"] = check_json(run);
  }
  object["times"] = times_json(run);
  return object;
}

}  // namespace tribound::io
