#include "tribound/io/record/report.h"

#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"
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

/// A table with rows put in front of its own.
std::string with_rows(const std::string& rows, const std::string& table)
{
  return table.substr(0, table.find('\n') + 1) + rows + rows_of(table);
}

}  // namespace

bool has_history(const RunRecord& run)
{
  return !run.levels.empty() && run.levels.front().load_step;
}

std::string convergence_csv(const RunRecord& run)
{
  if (has_history(run)) return convergence_csv(run.passes);
  return with_rows(run.earlier.convergence, convergence_csv(run.levels));
}

std::string newton_csv(const RunRecord& run)
{
  return with_rows(run.earlier.newton, newton_csv(run.levels));
}

EarlierLevels as_earlier(const RunRecord& run)
{
  return {rows_of(convergence_csv(run)), rows_of(newton_csv(run)), json_text(levels_json(run), -1),
          run.earlier.first_cells > 0 ? run.earlier.first_cells : run.mesh.cells};
}

void write_report(const std::filesystem::path& directory, const RunRecord& run)
{
  if (!run.effective.text.empty()) write_file(directory / run.case_file, run.effective.text);
  write_file(directory / "convergence.csv", convergence_csv(run));
  if (has_history(run)) write_file(directory / "history.csv", history_csv(run.levels));
  write_file(directory / "newton.csv", newton_csv(run));
  write_file(directory / "certificate.json", certificate_json(run));
}

}  // namespace tribound::io
