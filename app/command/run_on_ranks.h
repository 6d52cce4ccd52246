#pragma once

/// @file run_on_ranks.h
/// `tribound run` by several processes that mpirun or a batch system has started together.

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "app/command/run.h"

namespace tribound::app
{

/// As many as the environment says; 1 where it says nothing.
[[nodiscard]] int n_processes();
/// Whether it says that this is the first of them.
[[nodiscard]] bool is_first_process();

/// The exit code of a failure, and what to tell of it.
[[nodiscard]] std::pair<ExitCode, std::string> describe(const std::exception_ptr& failure);
/// Tells it on stderr.
int report(ExitCode code, const std::string& message);

/// What is to be run: a case file, or what a checkpoint says.
struct RunRequest
{
  std::string case_file;
  std::string restart;  ///< a directory of results, or a checkpoint in one; empty: the case file
  std::vector<std::string> overrides;
  bool quiet = false;
};

/// Runs it, on all processes that were started together, which may be one. The first reads the mesh, prints
/// and writes what is not of each. What fails on all of them the first one tells; what fails on one alone
/// ends all. Of one process it throws what run() does.
[[nodiscard]] ExitCode run_on_ranks(const RunRequest& request);

}  // namespace tribound::app
