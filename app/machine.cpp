#include "app/machine.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>

#include "tribound/base/memory.h"

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

MachineFacts find_out()
{
  MachineFacts facts;
  facts.processor = processor_name();
  facts.n_processors = static_cast<int>(std::max(0L, sysconf(_SC_NPROCESSORS_ONLN)));
  facts.memory = physical_memory();
  utsname system{};
  if (uname(&system) == 0)
    facts.system = std::string(system.sysname) + " " + system.release + ", " + system.machine;
  return facts;
}

}  // namespace

MachineFacts machine_facts()
{
  static const MachineFacts facts = find_out();
  return facts;
}

std::string date_and_time()
{
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &utc)};
}

}  // namespace tribound::app
