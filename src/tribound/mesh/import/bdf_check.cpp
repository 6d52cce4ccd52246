#include "tribound/mesh/import/bdf_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <string_view>

#include "tribound/base/error.h"
#include "tribound/mesh/import/inp_lines.h"

namespace tribound::mesh
{

namespace
{

/// Beginnings of the names of elements without a counterpart.
constexpr std::array<std::string_view, 27> elements = {
    "CBAR",  "CBEAM", "CBEND", "CROD",   "CONROD", "CTUBE",  "CELAS",   "CBUSH", "CDAMP",
    "CGAP",  "CMASS", "CONM",  "CSHEAR", "CTRIAX", "CQUADX", "CVISC",   "CWELD", "CFAST",
    "CSEAM", "CRAC",  "RBE",   "RBAR",   "RROD",   "RTRPLT", "RSPLINE", "GENEL", "PLOTEL"};

/// Field `number` of a line: 8 columns each, 16 behind a name with an asterisk, or between commas.
std::string_view field(std::string_view line, int number)
{
  if (line.find(',') != std::string_view::npos)
  {
    for (; number > 0; --number)
    {
      const std::size_t comma = line.find(',');
      if (comma == std::string_view::npos) return {};
      line.remove_prefix(comma + 1);
    }
    return trimmed(line.substr(0, line.find(',')));
  }
  constexpr std::size_t narrow = 8;
  const bool is_wide = line.substr(0, narrow).find('*') != std::string_view::npos;
  const std::size_t width = is_wide ? 2 * narrow : narrow;
  const std::size_t begin = number == 0 ? 0 : narrow + (number - 1) * width;
  return begin < line.size() ? trimmed(line.substr(begin, number == 0 ? narrow : width)) : std::string_view{};
}

}  // namespace

void check_bdf(const std::filesystem::path& file, bool ignores_elements, std::vector<std::string>& notes)
{
  std::ifstream stream(file, std::ios::binary);
  std::map<std::string, std::size_t> ignored;
  std::string text;
  for (int n = 1; std::getline(stream, text); ++n)
  {
    const auto fail = [&](const std::string& problem, const std::string& hint)
    { throw InputError({.file = file.string(), .line = n}, problem, hint); };
    const std::string_view line = std::string_view(text).substr(0, text.find('$'));
    std::string name = capitals(field(line, 0));
    if (name.ends_with('*')) name.pop_back();
    if (name == "ENDDATA") break;
    if (name.starts_with("INCLUDE")) fail("INCLUDE is not read", "put the files together");
    if (const std::string_view system = field(line, 2); name == "GRID" && !system.empty() && system != "0")
      fail(fmt::format("node {} is in coordinate system {}", field(line, 1), system),
           "write the nodes in the basic system");
    if (std::ranges::none_of(elements, [&](std::string_view begin) { return name.starts_with(begin); }))
      continue;
    if (!ignores_elements)
      fail(fmt::format("element {} is a {}, which has no counterpart", field(line, 1), name),
           "only solids, or plane elements alone, are read: ignore_elements = true leaves the others out");
    ++ignored[name];
  }
  std::string all;
  for (const auto& [name, n] : ignored) all += fmt::format("{}{} {}", all.empty() ? "" : ", ", n, name);
  if (!all.empty()) notes.push_back(fmt::format("{}: elements left out: {}", file.string(), all));
}

}  // namespace tribound::mesh
