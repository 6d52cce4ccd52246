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

void write_report(const std::filesystem::path& directory, const RunRecord& run)
{
  if (!run.effective.text.empty()) write_file(directory / run.case_file, run.effective.text);
  write_file(directory / "convergence.csv", convergence_csv(run.levels));
  write_file(directory / "newton.csv", newton_csv(run.levels));
  write_file(directory / "certificate.json", certificate_json(run));
}

}  // namespace tribound::io
