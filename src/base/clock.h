#pragma once

/// @file clock.h

#include <chrono>

namespace tribound
{

using Clock = std::chrono::steady_clock;

/// Wall time.
[[nodiscard]] inline double seconds_since(Clock::time_point begin)
{
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace tribound
