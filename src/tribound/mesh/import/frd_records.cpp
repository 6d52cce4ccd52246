#include "tribound/mesh/import/frd_records.h"

#include <fmt/format.h>

#include "tribound/mesh/import/file_text.h"

namespace tribound::mesh
{

FrdRecords::FrdRecords(const std::filesystem::path& file)
    : where_{.file = file.string()}, content_(content_of(file, where_, {})), lines_(content_, where_)
{
}

std::string_view FrdRecords::field(std::size_t begin, std::size_t width) const
{
  const std::string_view line = lines_.line();
  return begin < line.size() ? trimmed(line.substr(begin, width)) : std::string_view{};
}

std::int64_t FrdRecords::integer(std::size_t begin, std::size_t width, std::string_view what) const
{
  const auto value = integer_of(field(begin, width));
  if (!value) fail(fmt::format("{} is \"{}\"", what, field(begin, width)));
  return *value;
}

double FrdRecords::number(std::size_t begin, std::string_view what) const
{
  constexpr std::size_t width = 12;
  const auto value = number_of(field(begin, width));
  if (!value) fail(fmt::format("{} is \"{}\", not a number", what, field(begin, width)));
  return *value;
}

void FrdRecords::next_in(std::string_view block)
{
  if (!lines_.next()) fail(fmt::format("the file ends in the {}", block));
}

std::size_t FrdRecords::width_of_numbers() const
{
  const std::string_view line = trimmed(lines_.line());
  const std::string_view format = line.substr(line.find_last_of(" \t") + 1);
  if (format != "0" && format != "1")
    fail("the file is binary",
         "write it as text: *NODE FILE and *EL FILE, not *NODE OUTPUT and *ELEMENT OUTPUT");
  return format == "0" ? 5 : 10;
}

}  // namespace tribound::mesh
