#include "app/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "tribound/base/apart.h"

extern char** environ;

namespace tribound::app
{

Child start_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                    const ChildOptions& options)
{
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  if (!options.log.empty())
  {
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, options.log.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0666);
    ::posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  }
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  if (options.own_group)
  {
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    ::posix_spawnattr_setpgroup(&attributes, 0);
  }
  Child child;
  const int error =
      ::posix_spawn(&child.process, program.c_str(), &files, &attributes, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&attributes);
  if (error != 0) child.problem = fmt::format("cannot be started: {}", std::strerror(error));
  return child;
}

std::string run_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                        const ChildOptions& options)
{
  const Child child = start_program(program, std::move(arguments), options);
  if (!child.problem.empty()) return child.problem;
  int status = 0;
  while (::waitpid(child.process, &status, 0) < 0)
    if (errno != EINTR) return fmt::format("cannot be waited for: {}", std::strerror(errno));
  return describe_end(status);
}

}  // namespace tribound::app
