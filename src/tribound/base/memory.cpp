#include "tribound/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

namespace tribound
{

namespace
{

/// The smallest number in the files `name` of `mount` and of the folders from there to `mount`/`group`;
/// infinity where they say "max" or do not exist.
double smallest_limit(const std::filesystem::path& mount, const std::filesystem::path& group,
                      const char* name)
{
  double limit = std::numeric_limits<double>::infinity();
  const auto look_in = [&](const std::filesystem::path& folder)
  {
    std::ifstream file(folder / name);
    double allowed = 0;
    if (file >> allowed && allowed > 0) limit = std::min(limit, allowed);
  };
  std::filesystem::path folder = mount;
  look_in(folder);
  for (const std::filesystem::path& part : group) look_in(folder /= part);
  return limit;
}

}  // namespace

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

double address_space_limit()
{
  rlimit limit{};
  const bool is_limited = ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return is_limited ? static_cast<double>(limit.rlim_cur) : std::numeric_limits<double>::infinity();
}

double control_group_memory(const std::filesystem::path& groups, const std::filesystem::path& root)
{
  double limit = std::numeric_limits<double>::infinity();
  std::ifstream lines(groups);
  for (std::string line; std::getline(lines, line);)  // number:controllers:/group
  {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    if (controllers.empty())
      limit = std::min(limit, smallest_limit(root, group, "memory.max"));
    else if (("," + controllers + ",").find(",memory,") != std::string::npos)
      limit = std::min(limit, smallest_limit(root / "memory", group, "memory.limit_in_bytes"));
  }
  return limit;
}

double machine_memory()
{
  const double physical = physical_memory();
  const double allowed =
      std::min(control_group_memory("/proc/self/cgroup", "/sys/fs/cgroup"), address_space_limit());
  if (std::isinf(allowed)) return physical;
  return physical > 0 ? std::min(physical, allowed) : allowed;
}

}  // namespace tribound
