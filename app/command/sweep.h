#pragma once

/// @file sweep.h
/// `tribound sweep`: a case with other values of some of its keys, a process for each run.

#include <span>
#include <string>

#include "app/command/run.h"
#include "tribound/case/sweep_values.h"

namespace tribound::app
{

struct SweepOptions
{
  std::string case_file;
  std::span<const std::string> overrides;  ///< of every run
  int jobs = 1;                            ///< processes at a time
  bool resume = false;                     ///< keep what an earlier sweep has completed
};

/// Solves all cases of the table, each into a directory of its own below `sweep` in output.directory. Throws
/// InputError for a value that no case takes, before anything is solved.
/// Success: all certified; budget_used_up: some not, or interrupted; failed: some failed; bad_input: some
/// were refused.
[[nodiscard]] ExitCode sweep(const SweepOptions& options, const case_file::SweepTable& table);

}  // namespace tribound::app
