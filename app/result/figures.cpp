#include "app/result/study.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "app/console/text.h"
#include "app/shared_file.h"
#include "tribound/base/apart.h"

extern char** environ;

namespace tribound::app
{

std::string run_figure_script(const std::filesystem::path& script, const std::filesystem::path& directory)
{
  std::string program = script.string();
  std::string argument = std::filesystem::absolute(directory).string();
  const std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  // No shell, so that no part of a name is interpreted as a command. The first line of the script names its
  // Python.
  if (const int error = ::posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ);
      error != 0)
    return fmt::format("cannot be started: {}", std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return fmt::format("cannot be waited for: {}", std::strerror(errno));
  return describe_end(status);
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
