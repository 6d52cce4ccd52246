#pragma once

/// @file background.h
/// Work that goes on beside its caller.

#include <functional>
#include <future>
#include <utility>

#include "tribound/base/parallel.h"

namespace tribound::app
{

/// One job at a time, in a thread of its own where OpenMP offers more than one, else in place: start() then
/// returns when the job is done. What a job throws is thrown on, once. The end of this object waits for the
/// job and drops what it throws.
class Background
{
 public:
  /// Waits for the job before; throws what that has thrown, and does not start this one then.
  void start(std::function<void()> job)
  {
    wait();
    if (max_threads() > 1)
      job_ = std::async(std::launch::async, std::move(job));
    else
      job();
  }
  /// Waits for the job, if there is one, and throws what it has thrown.
  void wait()
  {
    if (job_.valid()) job_.get();
  }

 private:
  std::future<void> job_;
};

}  // namespace tribound::app
