#include "app/result/study.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/child_process.h"
#include "app/console/text.h"
#include "app/shared_file.h"

namespace tribound::app
{

std::string run_figure_script(const std::filesystem::path& script, const std::filesystem::path& directory)
{
  // The first line of the script names its Python.
  return run_program(script, {script.string(), std::filesystem::absolute(directory).string()});
}

void draw_figures(const std::filesystem::path& directory)
{
  std::fflush(stdout);
  const std::filesystem::path script = find_shared_file("study_figures");
  const std::string problem =
      script.empty() ? "the script study_figures is not installed" : run_figure_script(script, directory);
  print(line("figures", problem.empty() ? (directory / "figures").string()
                                        : fmt::format("not drawn: {}{}",
                                                      script.empty() ? "" : script.string() + " ", problem)));
}

}  // namespace tribound::app
