#pragma once

/// @file host.h
/// What a program takes over that runs commands in its own process, such as a Python interpreter.

#include <filesystem>
#include <functional>
#include <string_view>

namespace tribound::app
{

struct Host
{
  /// Signals belong to the host, which ends a run by request_stop(), and failures of runs on several ranks
  /// are thrown on all of them.
  bool is_present = false;
  std::filesystem::path program{};                ///< as if it were this program; empty: the running one
  std::function<void(std::string_view)> print{};  ///< results; empty: stdout
  std::function<void(std::string_view)> note{};   ///< what a reader leaves out; empty: stderr
};

/// That of this process; one run at a time uses it.
[[nodiscard]] Host& host();

}  // namespace tribound::app
