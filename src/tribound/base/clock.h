#pragma once

/// @file clock.h

#include <chrono>
#include <ctime>

namespace tribound
{

using Clock = std::chrono::steady_clock;

/// Wall time.
[[nodiscard]] inline double seconds_since(Clock::time_point begin)
{
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// CPU time of this process, all threads.
[[nodiscard]] inline double cpu_seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Adds the wall time and the CPU time of its life to two totals.
class ScopedTimer
{
 public:
  ScopedTimer(double& wall, double& cpu) : wall_(wall), cpu_(cpu) {}
  ~ScopedTimer()
  {
    wall_ += seconds_since(begin_);
    cpu_ += cpu_seconds() - cpu_begin_;
  }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& wall_;
  double& cpu_;
  Clock::time_point begin_ = Clock::now();
  double cpu_begin_ = cpu_seconds();
};

}  // namespace tribound
