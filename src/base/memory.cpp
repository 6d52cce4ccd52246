#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace tribound
{

double peak_memory()
{
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  constexpr double unit = 1;
#else
  constexpr double unit = 1024;
#endif
  return unit * static_cast<double>(usage.ru_maxrss);
}

double physical_memory()
{
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  const double page = static_cast<double>(sysconf(_SC_PAGESIZE));
  return pages > 0 && page > 0 ? pages * page : 0;
}

double machine_memory()
{
  const double physical = physical_memory();
  // "max" where the control group has no limit: reading a number then fails.
  std::ifstream group("/sys/fs/cgroup/memory.max");
  double allowed = 0;
  if (!(group >> allowed) || allowed <= 0) return physical;
  return physical > 0 ? std::min(physical, allowed) : allowed;
}

}  // namespace tribound
