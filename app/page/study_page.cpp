#include "app/page/study_page.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "app/page/page_template.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

namespace
{

/// The figures, by name; those older than the table that they are drawn from are of another study.
std::vector<std::string> figure_names(const std::filesystem::path& directory)
{
  std::vector<std::string> names;
  std::error_code none;  // there need not be a table or a directory of figures
  const auto drawn_after = std::filesystem::last_write_time(directory / "study.csv", none);
  for (const auto& entry : std::filesystem::directory_iterator(directory / "figures", none))
    if (entry.path().extension() == ".svg" && entry.last_write_time() >= drawn_after)
      names.push_back("figures/" + entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

/// In the order in which a reader wants them.
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

}  // namespace tribound::app
