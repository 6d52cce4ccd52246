#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <string>

#include "app/page/page_template.h"
#include "tribound/base/memory.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

namespace
{

std::string processor_name()
{
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
    {
      const std::size_t colon = line.find(": ");
      return colon == std::string::npos ? std::string{} : line.substr(colon + 2);
    }
  return {};
}

/// The current time, as in "2024-05-17 09:30 UTC".
std::string date_and_time()
{
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &utc)};
}

}  // namespace

io::Json machine_json()
{
  utsname system{};
  const bool is_known = uname(&system) == 0;
  return {
      {"processor", processor_name()},
      {"processors", std::max(0L, sysconf(_SC_NPROCESSORS_ONLN))},
      {"memory", physical_memory()},
      {"system", is_known ? std::string(system.sysname) + " " + system.release + ", " + system.machine : ""},
      {"written", date_and_time()}};
}

}  // namespace tribound::app
