#include "tribound/io/state/step_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include "tribound/base/error.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"

namespace tribound::io
{

namespace
{

/// The log file of a checkpoint; it need not exist.
std::filesystem::path log_of(const std::filesystem::path& checkpoint)
{
  const std::filesystem::path folder = checkpoint.has_parent_path() ? checkpoint.parent_path() : ".";
  std::error_code error;
  std::filesystem::path beside = folder / step_log_name;
  return std::filesystem::exists(beside, error) ? beside : folder / ".." / step_log_name;
}

/// In the order of their numbers; a repeated step replaces the earlier one.
std::vector<StepRows> steps_in(const std::filesystem::path& log, const LoggedSteps& which)
{
  std::vector<StepRows> steps(which.last);
  std::vector<char> is_there(which.last, 0);
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);)
  {
    const Json json = Json::parse(line, nullptr, false);
    if (json.is_discarded() || !json.is_array() || json.size() != 5 || json[0] != which.path) continue;
    const int step = json[1];
    if (step < 1 || step > which.last) continue;
    steps[step - 1] = {json[2], json[3], json[4]};
    is_there[step - 1] = 1;
  }
  const auto missing = std::ranges::find(is_there, 0) - is_there.begin();
  if (missing < which.last)
    throw InputError(
        {.file = log.string()},
        fmt::format("lacks the rows of load step {}, from which the checkpoint continues", missing + 1),
        fmt::format("keep {} in the directory of the checkpoint, or start the run anew", step_log_name));
  return steps;
}

}  // namespace

void append_step(const std::filesystem::path& log, const LoggedSteps& at, const StepRows& rows)
{
  const std::string line =
      "\n" + json_text({at.path, at.last, rows.history, rows.newton, rows.record}, -1) + "\n";
  const int file = ::open(log.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  // A line truncated by a kill ends where this one begins.
  const bool is_written = file >= 0 &&
                          ::write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
                          ::fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) ::close(file);
  if (!is_written)
    throw WriteError(log, "cannot be written: " + std::generic_category().message(reason),
                     hint_for_writing(reason));
}

std::vector<StepRows> read_steps(const std::filesystem::path& checkpoint, const LoggedSteps& which,
                                 const Ranks& ranks)
{
  std::vector<char> text;
  ranks.on_first(
      [&]
      {
        Json rows = Json::array();
        for (const StepRows& step : steps_in(log_of(checkpoint), which))
          rows.push_back({step.history, step.newton, step.record});
        const std::string packed = json_text(rows, -1);
        text.assign(packed.begin(), packed.end());
      });
  ranks.copy_from_first(text);
  std::vector<StepRows> steps;
  for (const Json& row : Json::parse(text)) steps.push_back({row[0], row[1], row[2]});
  return steps;
}

void copy_step_log(const std::filesystem::path& checkpoint, const std::filesystem::path& directory)
{
  const std::filesystem::path from = log_of(checkpoint);
  const std::filesystem::path to = directory / step_log_name;
  std::error_code error;
  if (!std::filesystem::exists(from, error) || std::filesystem::equivalent(from, to, error)) return;
  std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw WriteError(to, "cannot be written: " + error.message(), hint_for_writing(error.value()));
}

}  // namespace tribound::io
