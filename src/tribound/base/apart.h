#pragma once

/// @file apart.h
/// Work in a process of its own, which may crash, hang or use up memory without harm to this one.

#include <atomic>
#include <functional>
#include <string>

namespace tribound
{

struct ApartLimits
{
  double silence = 300;                     ///< s without a word of output or a byte of the result
  double memory = 0;                        ///< bytes beyond what this process has; 0: no limit
  const std::atomic<bool>* stop = nullptr;  ///< once true, the work is given up
};

enum class ApartEnd
{
  complete,
  crashed,
  out_of_time,  ///< ended by limit_from_here()
  silent,       ///< ended by ApartLimits::silence
  stopped       ///< ended by ApartLimits::stop
};

struct ApartOutcome
{
  ApartEnd end = ApartEnd::crashed;
  std::string result{};  ///< what `work` has returned, if complete
  std::string output{};  ///< the last of what it has printed
  int status = 0;        ///< as of waitpid()
};

/// Runs `work` in a copy of this process (fork) and returns its result; its output on stdout and stderr is
/// kept, not shown. `work` must not throw, nor use threads or OpenMP teams that this process has started. The
/// copy is gone when this returns, and ends with this process if that is killed. Throws SolveError if the
/// system cannot start a process.
[[nodiscard]] ApartOutcome run_apart(const std::function<std::string()>& work,
                                     const ApartLimits& limits = {});

/// For `work` that knows how much it needs: from now on this process gets at most `memory` bytes more,
/// beyond which allocations fail, and ends as ApartEnd::out_of_time after `seconds` more of CPU time.
/// Infinity: no limit. Lower limits already in force stay.
void limit_from_here(double memory, double seconds);

/// "was ended by signal 11 (Segmentation fault)", "ended with exit code 1"; empty for success.
[[nodiscard]] std::string describe_end(int status);

}  // namespace tribound
