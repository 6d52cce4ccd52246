#pragma once

/// @file step_log.h
/// The rows of the load steps before a checkpoint, in a separate file. Each is written once, so the size of a
/// checkpoint does not grow with the number of steps.

#include <filesystem>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/io/record/report.h"

namespace tribound::io
{

inline constexpr const char* step_log_name = "checkpoint_steps.jsonl";

/// The steps that belong to a checkpoint: 1, ..., last of a path, which each pass follows anew.
struct LoggedSteps
{
  int path = 0;
  int last = 0;
};

/// Appends the step number `at.last`; earlier rows with that number become invalid. On disk when it returns.
/// Throws WriteError.
void append_step(const std::filesystem::path& log, const LoggedSteps& at, const StepRows& rows);

/// The rows of all steps, from the file next to a checkpoint, or in the parent directory. Lines only partly
/// written by a killed program are ignored. All ranks call it together; the first reads. Throws InputError
/// where rows are missing.
[[nodiscard]] std::vector<StepRows> read_steps(const std::filesystem::path& checkpoint,
                                               const LoggedSteps& which, const Ranks& ranks);

/// For a run that continues in another directory than that of its checkpoint: copies the file there. Throws
/// WriteError.
void copy_step_log(const std::filesystem::path& checkpoint, const std::filesystem::path& directory);

}  // namespace tribound::io
