#include "app/background.h"

#include <utility>

#include "tribound/base/parallel.h"

namespace tribound::app
{

void Background::start(std::function<void()> job)
{
  wait();
  const bool beside = max_threads() > 1;
  job_ = std::async(beside ? std::launch::async : std::launch::deferred, std::move(job));
  if (!beside) wait();
}

void Background::wait()
{
  if (job_.valid()) job_.get();
}

}  // namespace tribound::app
