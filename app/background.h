#pragma once

/// @file background.h
/// Work in the background of its caller.

#include <functional>
#include <future>
#include <utility>

#include "tribound/base/parallel.h"

namespace tribound::app
{

/// Runs one job at a time, in a thread of its own where OpenMP offers more than one, else in place: start()
/// then returns when the job is done. An exception of a job is rethrown once. The destructor waits for the
/// job and drops its exception.
class Background
{
 public:
  /// Waits for the previous job; if that has thrown, rethrows and does not start this one.
  void start(std::function<void()> job)
  {
    wait();
    if (max_threads() > 1)
      job_ = std::async(std::launch::async, std::move(job));
    else
      job();
  }
  /// Waits for the job, if there is one, and rethrows its exception.
  void wait()
  {
    if (job_.valid()) job_.get();
  }

 private:
  std::future<void> job_;
};

}  // namespace tribound::app
