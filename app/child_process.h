#pragma once

/// @file child_process.h
/// Other programs, started without a shell, so that no part of a name is interpreted as a command.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tribound::app
{

/// Where the output of a program goes, and which signals from the keyboard it gets.
struct ChildOptions
{
  std::filesystem::path log{};  ///< of stdout and stderr, stdin is empty; without one, all three are ours
  bool own_group = false;       ///< Ctrl-C reaches only this process
};

/// A program that runs.
struct Child
{
  pid_t process = 0;
  std::string problem{};  ///< why it cannot be started; empty: it runs
};

/// Starts the program with these arguments, the first of which is its name.
[[nodiscard]] Child start_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                                  const ChildOptions& options = {});

/// Starts it and waits for its end. Empty for success, else why it failed: "ended with exit code 1".
[[nodiscard]] std::string run_program(const std::filesystem::path& program,
                                      std::vector<std::string> arguments, const ChildOptions& options = {});

}  // namespace tribound::app
