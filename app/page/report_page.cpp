#include "app/page/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/page/packed_array.h"
#include "app/page/page_level.h"
#include "app/result/study.h"
#include "app/result/sweep.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/observations_json.h"
#include "tribound/io/record/record_json.h"
#include "tribound/io/record/tables.h"

namespace tribound::app
{

namespace
{

/// Largest table on the page, in characters.
constexpr std::size_t largest_table = 400'000;

/// A table that can be copied from the page; null where it is too large.
io::Json table(std::string_view text)
{
  io::Json packed = pack_text(text);
  return text.empty() || io::json_text(packed, -1).size() > largest_table ? io::Json(nullptr) : packed;
}

io::Json tables_json(const io::RunRecord& run, const std::string& contact)
{
  io::Json tables{{"convergence.csv", table(io::convergence_csv(run))},
                  {"newton.csv", table(io::newton_csv(run))},
                  {"contact.csv", table(contact)}};
  if (io::has_history(run)) tables["history.csv"] = table(io::history_csv(run));
  if (const std::string quantities = io::quantities_csv(io::levels_json(run), run.facts); !quantities.empty())
    tables["quantities.csv"] = table(quantities);
  const io::Json solutions = io::has_history(run) ? io::steps_json(run) : io::levels_json(run);
  if (const std::string probes = io::probes_csv(solutions); !probes.empty())
    tables["probes.csv"] = table(probes);
  if (const std::string sections = io::sections_csv(solutions); !sections.empty())
    tables["sections.csv"] = table(sections);
  return tables;
}

/// The effective case with its text.
io::Json case_json(const io::RunRecord& run)
{
  io::Json object = io::effective_case_json(run.effective, run.case_file);
  if (!object.is_null()) object["text"] = run.effective.text;
  return object;
}

/// The Newton steps of all levels with the components of the bound.
io::Json newton_json(const io::RunRecord& run)
{
  io::Json steps = io::Json::array();
  for (const io::TableRow& row : io::newton_rows(run.levels)) steps.push_back(io::row_json(row));
  return steps;
}

/// Over all levels.
std::size_t n_triangles(std::span<const PageLevel> levels)
{
  std::size_t n = 0;
  for (const PageLevel& level : levels) n += level.n_triangles;
  return n;
}

/// The files of a run, in the order of interest to a reader.
std::vector<std::string> run_files(const io::RunRecord& run)
{
  std::vector<std::string> names = {"certificate.json", run.case_file,  "convergence.csv", "quantities.csv",
                                    "probes.csv",       "sections.csv", "history.csv",     "newton.csv",
                                    "contact.csv",      "adapted.msh",  "series.pvd"};
  const std::string_view stem = io::has_history(run) ? "step" : "level";
  for (const io::LevelRecord& level : run.levels)
    for (const std::string& name :
         {io::level_file_name(stem, level.level), fmt::format("{}_{:03}.pvtu", stem, level.level),
          io::level_file_name("contact", level.level)})
      names.push_back(name);
  return names;
}

/// The figures, by name; those older than the table they are drawn from belong to another study.
std::vector<std::string> figure_names(const std::filesystem::path& directory)
{
  std::vector<std::string> names;
  std::error_code none;  // a table or a directory of figures may not exist
  const auto drawn_after = std::filesystem::last_write_time(directory / "study.csv", none);
  for (const auto& entry : std::filesystem::directory_iterator(directory / "figures", none))
    if (entry.path().extension() == ".svg" && entry.last_write_time() >= drawn_after)
      names.push_back("figures/" + entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

/// The files of a study, in the order of interest to a reader.
std::vector<std::string> study_files(const std::filesystem::path& directory, const Study& study)
{
  std::vector<std::string> names = {"study.csv", "study.json"};
  for (const StudyVariant& variant : study.variants) names.push_back(variant.name + "/report.html");
  if (study.reference) names.emplace_back("reference/report.html");
  std::ranges::copy(figure_names(directory), std::back_inserter(names));
  return names;
}

}  // namespace

void write_study_page(const std::filesystem::path& page_template, const std::filesystem::path& directory,
                      const Study& study)
{
  const PageTemplate page(page_template);
  if (page.empty()) return;
  page.write(directory / "report.html", "study-data",
             {{"study", study_object(study)},
              {"components", components_json(run_kind(study))},
              {"machine", machine_json()},
              {"files", files_json(directory, study_files(directory, study))}});
}

void write_sweep_results(const PageTemplate& page, const std::filesystem::path& directory,
                         const SweepRecord& sweep)
{
  const io::Json object = sweep_object(sweep);
  write_sweep(directory, sweep, object);
  if (page.empty()) return;
  std::vector<std::string> files = {"sweep.csv", "sweep.json"};
  for (const SweepRun& run : sweep.runs) files.push_back(run.name + "/report.html");
  page.write(directory / "report.html", "sweep-data",
             {{"sweep", object}, {"machine", machine_json()}, {"files", files_json(directory, files)}});
}

void add_true_errors(const std::filesystem::path& page, std::span<const TrueErrors> errors)
{
  std::string text = io::read_text(page);
  const std::size_t marker = text.rfind(true_errors_marker);
  if (marker == std::string::npos) return;
  io::Json rows = io::Json::array();
  for (const TrueErrors& row : errors)
  {
    rows.push_back({{"level", row.level}});
    if (row.stress_error) rows.back()["stress_error"] = *row.stress_error;
    if (row.dual_norm) rows.back()["dual_norm"] = *row.dual_norm;
  }
  text.replace(marker, true_errors_marker.size(),
               R"(<script type="application/json" id="true-errors">)" + rows.dump() + "</script>");
  io::write_file(page, text);
}

ReportPage::ReportPage(const std::filesystem::path& page_template) : template_(page_template) {}
ReportPage::~ReportPage() = default;
ReportPage::ReportPage(ReportPage&&) noexcept = default;
ReportPage& ReportPage::operator=(ReportPage&&) noexcept = default;

template <int dim>
void ReportPage::add(int number, const contact::NitscheForm<dim>& form,
                     const adapt::CertifiedLevel<dim>& level)
{
  if (template_.empty()) return;
  constexpr PageLimits limits{.subdivided = 6000, .stresses = 6000, .segments = 6000};
  if (!levels_.empty() && n_triangles(levels_) + n_triangles(form, limits) > limits.earlier) return;
  levels_.push_back(page_level(number, form, level, limits));
}

template <int dim>
void ReportPage::add_last(int number, const contact::NitscheForm<dim>& form,
                          const adapt::CertifiedLevel<dim>& level)
{
  if (template_.empty()) return;
  std::erase_if(levels_, [number](const PageLevel& other) { return other.number == number; });
  levels_.push_back(page_level(number, form, level));
  if constexpr (dim == 3) levels_.back().volume = page_volume(form, level);
}

void ReportPage::write(const std::filesystem::path& directory, const io::RunRecord& run) const
{
  if (template_.empty()) return;
  io::Json fields = io::Json::array();
  for (const PageLevel& level : levels_) fields.push_back(level.json);
  template_.write(directory / "report.html", "run-data",
                  {{"certificate", io::certificate(run)},
                   {"components", components_json(io::run_kind(run.levels))},
                   {"case", case_json(run)},
                   {"newton", newton_json(run)},
                   {"tables", tables_json(run, levels_.empty() ? std::string{}
                                                               : io::read_text(directory / "contact.csv"))},
                   {"machine", machine_json()},
                   {"files", files_json(directory, run_files(run))},
                   {"volume", levels_.empty() ? io::Json(nullptr) : levels_.back().volume},
                   {"fields", std::move(fields)}});
}

template void ReportPage::add(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template void ReportPage::add(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);
template void ReportPage::add_last(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template void ReportPage::add_last(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);

}  // namespace tribound::app
