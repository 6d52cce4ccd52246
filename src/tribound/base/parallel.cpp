#include "tribound/base/parallel.h"

#include <omp.h>

#include <atomic>
#include <exception>
#include <vector>

namespace tribound
{

int max_threads()
{
  return omp_get_max_threads();
}

void set_max_threads(int n)
{
  omp_set_num_threads(n);
}

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, int grain)
{
  // Waking threads and letting them wait costs more than some loops.
  constexpr std::size_t worth_threads = 32;
  std::exception_ptr failure;
  std::atomic<std::size_t> failed = n;
#pragma omp parallel for schedule(dynamic, grain) if (n > worth_threads * grain)
  for (std::size_t i = 0; i < n; ++i)
  {
    if (i > failed) continue;  // no longer of interest
    try
    {
      body(i);
    }
    catch (...)
    {
#pragma omp critical(tribound_parallel_for)
      if (i < failed)
      {
        failed = i;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void in_threads(int n, const std::function<void(int)>& work)
{
  std::vector<std::exception_ptr> failures(n);
#pragma omp parallel for num_threads(n) schedule(static, 1)
  for (int i = 0; i < n; ++i) try
    {
      work(i);
    }
    catch (...)
    {
      failures[i] = std::current_exception();
    }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace tribound
