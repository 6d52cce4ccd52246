#include "tribound/mesh/import/cad_unit.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/inp_lines.h"

namespace tribound::mesh
{

namespace
{

std::string found_in(const std::map<std::string_view, std::string_view>& names, const std::string& name)
{
  const auto found = names.find(name);
  return found == names.end() ? std::string() : std::string(found->second);
}

/// The text between the semicolons on both sides, as far as it is not absurdly long.
std::string statement_around(const std::string& text, std::size_t at)
{
  constexpr std::size_t most = 1000;
  std::size_t begin = at;
  while (begin > 0 && at - begin < most && text[begin - 1] != ';') --begin;
  return text.substr(begin, std::min(text.find(';', at), at + most) - begin);
}

/// Without blanks, from behind the first to the next second character; empty: there is none.
std::string between(const std::string& text, std::size_t from, char first, char second)
{
  const std::size_t begin = text.find(first, from);
  if (begin == std::string::npos) return {};
  const std::size_t end = text.find(second, begin + 1);
  return end == std::string::npos ? std::string()
                                  : std::string(trimmed(text.substr(begin + 1, end - begin - 1)));
}

/// Units that are given by others, "( CONVERSION_BASED_UNIT('INCH',#7) LENGTH_UNIT() NAMED_UNIT(#8) )", and
/// those by SI, "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )". The first kind is made of the
/// second, which then is not the unit of the file.
std::string unit_of_step(const std::string& text)
{
  static const std::map<std::string_view, std::string_view> conversions = {
      {"INCH", "INCH"}, {"INCHES", "INCH"}, {"IN", "INCH"},      {"FOOT", "FT"},       {"FEET", "FT"},
      {"FT", "FT"},     {"MILE", "MI"},     {"MIL", "MIL"},      {"MILLIMETRE", "MM"}, {"MILLIMETER", "MM"},
      {"METRE", "M"},   {"METER", "M"},     {"CENTIMETRE", "CM"}};
  static const std::map<std::string_view, std::string_view> prefixes = {
      {"$", "M"}, {".MILLI.", "MM"}, {".CENTI.", "CM"}, {".MICRO.", "UM"}, {".KILO.", "KM"}};
  std::set<std::string> converted;
  std::set<std::string> si;
  constexpr std::string_view length = "LENGTH_UNIT";
  for (std::size_t at = text.find(length); at != std::string::npos;
       at = text.find(length, at + length.size()))
  {
    const std::string entity = statement_around(text, at);
    if (const std::size_t name = entity.find("CONVERSION_BASED_UNIT"); name != std::string::npos)
      converted.insert(found_in(conversions, capitals(between(entity, name, '\'', '\''))));
    else if (const std::size_t prefix = entity.find("SI_UNIT"); prefix != std::string::npos)
      si.insert(found_in(prefixes, between(entity, prefix, '(', ',')));
  }
  const std::set<std::string>& units = converted.empty() ? si : converted;
  return units.size() == 1 ? *units.begin() : std::string();
}

/// The parameters of the global section: columns 1 to 72 of the lines with a G in column 73; texts are
/// "4HINCH".
std::vector<std::string> global_parameters(const std::string& text)
{
  constexpr std::size_t width = 72;
  std::string section;
  for (std::size_t begin = 0; begin < text.size();)
  {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    if (line.size() > width && line[width] == 'G') section += line.substr(0, width);
    begin = end + 1;
  }
  std::vector<std::string> parameters;
  std::string field;
  for (std::size_t i = 0; i < section.size(); ++i)
  {
    const char c = section[i];
    const bool is_count =
        !field.empty() && std::ranges::all_of(field, [](char d) { return d >= '0' && d <= '9'; });
    if (c == 'H' && is_count && field.size() < 5)
    {
      const std::size_t n = std::stoul(field);
      field = section.substr(i + 1, n);
      parameters.push_back(field);
      field.clear();
      i += n + 1;  // the delimiter, too
    }
    else if (c == ',' || c == ';')
    {
      parameters.push_back(field);
      field.clear();
    }
    else if (c != ' ')
      field += c;
  }
  return parameters;
}

/// The 15th parameter is the name, the 14th its number: 3 means that the name counts.
std::string unit_of_iges(const std::string& text)
{
  static const std::map<std::string_view, std::string_view> names = {
      {"INCH", "INCH"}, {"IN", "INCH"}, {"MM", "MM"}, {"FT", "FT"}, {"MI", "MI"},  {"M", "M"},
      {"KM", "KM"},     {"MIL", "MIL"}, {"UM", "UM"}, {"CM", "CM"}, {"UIN", "UIN"}};
  constexpr std::array<std::string_view, 12> numbered = {"",  "INCH", "MM",  "",   "FT", "MI",
                                                         "M", "KM",   "MIL", "UM", "CM", "UIN"};
  constexpr std::size_t number_place = 13;
  const std::vector<std::string> parameters = global_parameters(text);
  if (parameters.size() > number_place + 1)
    if (const std::string name = found_in(names, parameters[number_place + 1]); !name.empty()) return name;
  if (parameters.size() <= number_place) return {};
  const std::optional<std::int64_t> number = integer_of(parameters[number_place]);
  if (!number || *number < 0 || *number >= std::ssize(numbered)) return {};
  return std::string(numbered[*number]);
}

}  // namespace

std::string length_unit(const std::filesystem::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return suffix_of(file).starts_with(".i") ? unit_of_iges(text) : unit_of_step(text);
}

}  // namespace tribound::mesh
