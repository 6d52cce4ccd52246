#pragma once

/// @file step_log.h
/// The rows of the load steps that a checkpoint goes on from, in a file beside it: each is written once, and
/// a checkpoint of a path with many steps is not larger than one with few.

#include <filesystem>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/io/record/report.h"

namespace tribound::io
{

inline constexpr const char* step_log_name = "checkpoint_steps.jsonl";

/// Which of them belong to a checkpoint: the steps 1, ..., last of a path, which each pass follows anew.
struct LoggedSteps
{
  int path = 0;
  int last = 0;
};

/// Appends the step number `at.last`; rows of that number that are there do not count any more. On disk when
/// it returns. Throws WriteError.
void append_step(const std::filesystem::path& log, const LoggedSteps& at, const StepRows& rows);

/// The rows of all steps, from the file beside a checkpoint, or in the folder that it is in. What a program
/// that was killed has written in part does not count. All ranks call it together; the first reads. Throws
/// InputError where rows are missing.
[[nodiscard]] std::vector<StepRows> read_steps(const std::filesystem::path& checkpoint,
                                               const LoggedSteps& which, const Ranks& ranks);

/// For a run that goes on in another directory than that of its checkpoint: copies the file there. Throws
/// WriteError.
void copy_step_log(const std::filesystem::path& checkpoint, const std::filesystem::path& directory);

}  // namespace tribound::io
