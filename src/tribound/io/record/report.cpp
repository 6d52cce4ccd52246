#include "tribound/io/record/report.h"

#include <algorithm>
#include <span>
#include <utility>

#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/level_json.h"
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

/// A table without its first line, which names the columns.
std::string rows_of(const std::string& table)
{
  return table.substr(table.find('\n') + 1);
}

/// One table after another with the same columns.
std::string joined(const std::string& earlier, const std::string& table)
{
  return rows_of(earlier).empty() ? table : earlier + rows_of(table);
}

/// The load step as the worst of a pass; nothing where it is an earlier one.
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
          .first_cells = run.earlier.first_cells > 0 ? run.earlier.first_cells : run.mesh.cells};
}

EarlierLevels as_earlier(const RunRecord& run, int pass, int worst_step)
{
  EarlierLevels earlier = as_earlier(run);
  earlier.history = history_csv(run);
  earlier.steps = json_text(steps_json(run), -1);
  earlier.worst_convergence = run.earlier.worst_convergence;
  earlier.worst_level = run.earlier.worst_level;
  if (const std::optional<LevelRecord> worst = as_pass(run, pass, worst_step))
  {
    earlier.worst_convergence = convergence_csv(std::span(&*worst, 1));
    earlier.worst_level = json_text(level_json(*worst), -1);
  }
  return earlier;
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
                        .dissipated = last.at("dissipated"),
                        .rubbed = last.at("dissipated_friction"),
                        .work = last.at("work")};
}

void write_report(const std::filesystem::path& directory, const RunRecord& run)
{
  if (!run.effective.text.empty()) write_file(directory / run.case_file, run.effective.text);
  write_file(directory / "convergence.csv", convergence_csv(run));
  if (has_history(run)) write_file(directory / "history.csv", history_csv(run));
  if (const std::string quantities = quantities_csv(levels_json(run), run.facts); !quantities.empty())
    write_file(directory / "quantities.csv", quantities);
  write_file(directory / "newton.csv", newton_csv(run));
  write_file(directory / "certificate.json", certificate_json(run));
}

}  // namespace tribound::io
