#include "tribound/io/record/report.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <utility>

#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/level_json.h"
#include "tribound/io/record/observations_json.h"
#include "tribound/io/record/record_json.h"
#include "tribound/io/record/tables.h"

namespace tribound::io
{

std::string certificate_json(const RunRecord& run)
{
  return json_text(certificate(run));
}

namespace
{

/// A table without its first line, the column names.
std::string rows_of(const std::string& table)
{
  return table.substr(table.find('\n') + 1);
}

std::string first_line(const std::string& table)
{
  return table.substr(0, table.find('\n') + 1);
}

std::int64_t first_cells(const RunRecord& run)
{
  return run.earlier.first_cells > 0 ? run.earlier.first_cells : run.mesh.cells;
}

/// Concatenates two tables with the same columns.
std::string joined(const std::string& earlier, const std::string& table)
{
  return rows_of(earlier).empty() ? table : earlier + rows_of(table);
}

/// The load step as the worst one of a pass; nothing where it precedes a restart.
std::optional<LevelRecord> as_pass(const RunRecord& run, int pass, int worst_step)
{
  const auto worst = std::ranges::find(run.levels, worst_step, &LevelRecord::level);
  if (worst == run.levels.end()) return std::nullopt;
  LevelRecord record = *worst;
  record.level = pass;
  record.load_step_number = worst_step;
  return record;
}

}  // namespace

bool has_history(const RunRecord& run)
{
  return (!run.levels.empty() && run.levels.front().load_step) || !run.earlier.steps.empty();
}

std::string convergence_csv(const RunRecord& run)
{
  return joined(run.earlier.convergence, convergence_csv(has_history(run) ? run.passes : run.levels));
}

std::string history_csv(const RunRecord& run)
{
  return joined(run.earlier.history, history_csv(run.levels));
}

std::string newton_csv(const RunRecord& run)
{
  return joined(run.earlier.newton, newton_csv(run.levels));
}

EarlierLevels as_earlier(const RunRecord& run)
{
  return {.convergence = convergence_csv(run),
          .newton = newton_csv(run),
          .levels = json_text(levels_json(run), -1),
          .first_cells = first_cells(run)};
}

EarlierLevels as_earlier(const RunRecord& run, int pass, int worst_step)
{
  const std::span last(&run.levels.back(), 1);
  EarlierLevels earlier{.convergence = convergence_csv(run),
                        .newton = first_line(newton_csv(last)),
                        .levels = json_text(levels_json(run), -1),
                        .first_cells = first_cells(run),
                        .history = first_line(history_csv(last)),
                        .worst_convergence = run.earlier.worst_convergence,
                        .worst_level = run.earlier.worst_level};
  if (const std::optional<LevelRecord> worst = as_pass(run, pass, worst_step))
  {
    earlier.worst_convergence = convergence_csv(std::span(&*worst, 1));
    earlier.worst_level = json_text(level_json(*worst), -1);
  }
  return earlier;
}

StepRows last_step_rows(const RunRecord& run)
{
  const std::span last(&run.levels.back(), 1);
  return {rows_of(history_csv(last)), rows_of(newton_csv(last)), json_text(level_json(last.front()), -1)};
}

void add_steps(EarlierLevels& earlier, std::span<const StepRows> steps)
{
  for (const StepRows& step : steps)
  {
    earlier.history += step.history;
    earlier.newton += step.newton;
    earlier.steps += (earlier.steps.empty() ? "[" : ",") + step.record;
  }
  if (!steps.empty()) earlier.steps += "]";
}

void drop_steps(EarlierLevels& earlier)
{
  for (std::string* text :
       {&earlier.newton, &earlier.history, &earlier.steps, &earlier.worst_convergence, &earlier.worst_level})
    text->clear();
}

void complete_pass(RunRecord& run, int pass, int worst_step)
{
  if (std::optional<LevelRecord> worst = as_pass(run, pass, worst_step))
  {
    run.passes.push_back(*std::move(worst));
    return;
  }
  EarlierLevels& earlier = run.earlier;
  earlier.convergence = joined(earlier.convergence, earlier.worst_convergence);
  Json levels = Json::parse(earlier.levels);
  levels.push_back(Json::parse(earlier.worst_level));
  earlier.levels = json_text(levels, -1);
}

std::optional<LoadStepRecord> last_load_step(const RunRecord& run)
{
  if (!run.levels.empty()) return run.levels.back().load_step;
  if (run.earlier.steps.empty()) return std::nullopt;
  const Json last = Json::parse(run.earlier.steps).back();
  return LoadStepRecord{.t = last.at("t"),
                        .effective_normal = last.at("effective_normal"),
                        .tangential = last.at("effective_tangential"),
                        .dissipated = last.at("dissipated"),
                        .rubbed = last.at("dissipated_friction"),
                        .work = last.at("work")};
}

namespace
{

/// The certificate in the directory; a discarded value where there is none.
Json certificate_in(const std::filesystem::path& directory)
{
  std::ifstream file(directory / "certificate.json");
  return Json::parse(file, nullptr, false);
}

}  // namespace

bool has_history_check(const std::filesystem::path& directory)
{
  return certificate_in(directory).contains("history_check");
}

void add_history_check(const std::filesystem::path& directory, const RunRecord& run)
{
  Json object = certificate_in(directory);
  if (!object.is_object()) return;
  object["history_check"] = check_json(run);
  write_file(directory / "certificate.json", json_text(object));
}

void write_report(const std::filesystem::path& directory, const RunRecord& run)
{
  if (!run.effective.text.empty()) write_file(directory / run.case_file, run.effective.text);
  write_file(directory / "convergence.csv", convergence_csv(run));
  if (has_history(run)) write_file(directory / "history.csv", history_csv(run));
  if (const std::string quantities = quantities_csv(levels_json(run), run.facts); !quantities.empty())
    write_file(directory / "quantities.csv", quantities);
  const Json solutions = has_history(run) ? steps_json(run) : levels_json(run);
  if (const std::string probes = probes_csv(solutions); !probes.empty())
    write_file(directory / "probes.csv", probes);
  if (const std::string sections = sections_csv(solutions); !sections.empty())
    write_file(directory / "sections.csv", sections);
  write_file(directory / "newton.csv", newton_csv(run));
  write_file(directory / "certificate.json", certificate_json(run));
}

}  // namespace tribound::io
