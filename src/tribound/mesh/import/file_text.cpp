#include "tribound/mesh/import/file_text.h"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <limits>
#include <system_error>

namespace tribound::mesh
{

std::string content_of(const std::filesystem::path& file, const Where& where, const std::string& hint)
{
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(where, fmt::format("the file \"{}\" does not exist", file.string()), hint);
  std::ifstream stream(file, std::ios::binary);
  std::string content(std::filesystem::file_size(file, error), '\0');
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (!stream) throw InputError(where, fmt::format("the file \"{}\" cannot be read", file.string()));
  return content;
}

std::string small_letters(std::string_view text)
{
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string suffix_of(const std::filesystem::path& file)
{
  return small_letters(file.extension().string());
}

bool is_utf8(std::string_view name)
{
  for (std::size_t i = 0; i < name.size(); ++i)
  {
    const auto byte = static_cast<unsigned char>(name[i]);
    int n_more = byte < 0x80                   ? 0
                 : byte >= 0xc2 && byte < 0xe0 ? 1
                 : byte >= 0xe0 && byte < 0xf0 ? 2
                 : byte >= 0xf0 && byte < 0xf5 ? 3
                                               : -1;
    const bool is_control = byte < 0x20 || byte == 0x7f;
    for (; n_more > 0 && i + 1 < name.size() && (static_cast<unsigned char>(name[i + 1]) & 0xc0U) == 0x80U;
         ++i)
      --n_more;
    if (n_more != 0 || is_control) return false;
  }
  return true;
}

std::optional<std::int64_t> integer_of(std::string_view field)
{
  if (field.starts_with('+')) field.remove_prefix(1);
  constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max() / 4;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return {};
  if (value > largest || value < -largest) return {};
  return value;
}

std::optional<double> number_of(std::string_view field)
{
  if (field.starts_with('+')) field.remove_prefix(1);
  std::string with_e;
  if (const std::size_t d = field.find_first_of("dD"); d != std::string_view::npos)
  {
    with_e = field;
    with_e[d] = 'e';
    field = with_e;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return {};
  return value;
}

}  // namespace tribound::mesh
