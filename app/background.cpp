#include "app/background.h"

#include <utility>

#include "tribound/base/parallel.h"

namespace tribound::app
{

void Background::start(std::function<void()> job)
{
  wait();
  if (max_threads() > 1)
    job_ = std::async(std::launch::async, std::move(job));
  else
    job();
}

void Background::wait()
{
  if (job_.valid()) job_.get();
}

}  // namespace tribound::app
