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

/// CPU time of the calling thread.
[[nodiscard]] inline double thread_cpu_seconds()
{
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Adds the wall time and the CPU time of its life to two totals.
class ScopedTimer
{
 public:
  ScopedTimer(double& wall, double& cpu, double (*cpu_clock)() = cpu_seconds)
      : wall_(wall), cpu_(cpu), cpu_clock_(cpu_clock)
  {
  }
  ~ScopedTimer()
  {
    wall_ += seconds_since(begin_);
    cpu_ += cpu_clock_() - cpu_begin_;
  }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& wall_;
  double& cpu_;
  double (*cpu_clock_)();
  Clock::time_point begin_ = Clock::now();
  double cpu_begin_ = cpu_clock_();
};

}  // namespace tribound
