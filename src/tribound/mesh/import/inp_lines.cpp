#include "tribound/mesh/import/inp_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tribound::mesh
{

namespace
{

constexpr std::string_view blanks = " \t\r\f\v";

std::string_view without_blanks(std::string_view text)
{
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Keyword lines may have blanks anywhere: "*SOLID  SECTION" is "SOLID SECTION", "EL SET" is "ELSET".
std::string keyword_name(std::string_view text)
{
  std::string name;
  for (const char c : without_blanks(text))
    if (blanks.find(c) == std::string_view::npos)
      name += c;
    else if (name.back() != ' ')
      name += ' ';
  return capitals(name);
}

}  // namespace

std::string capitals(std::string_view text)
{
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

std::string_view trimmed(std::string_view text)
{
  text = without_blanks(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    text = without_blanks(text.substr(1, text.size() - 2));
  return text;
}

std::optional<std::string> InpKeyword::find(std::string_view parameter) const
{
  const auto found = std::ranges::find(parameters, parameter, &std::pair<std::string, std::string>::first);
  if (found == parameters.end()) return {};
  return found->second;
}

InpLines::InpLines(const std::filesystem::path& file)
{
  open(file);
}

void InpLines::open(const std::filesystem::path& file)
{
  const Where here = files_.empty() ? Where{.file = file.string()} : where(place_);
  open_.push_back(
      {static_cast<int>(files_.size()),
       content_of(file, here, "names of included files are relative to the file that includes them")});
  files_.push_back(file);
}

void InpLines::include(const std::string& name)
{
  constexpr std::size_t most_files = 10000;
  constexpr std::size_t deepest = 100;
  if (name.empty()) fail(place_, "*INCLUDE without a file", "*INCLUDE, INPUT=mesh.inp");
  const std::filesystem::path file = files_[open_.back().file].parent_path() / name;
  std::error_code error;
  for (const Source& source : open_)
    if (std::filesystem::equivalent(files_[source.file], file, error))
      fail(place_, fmt::format("the file \"{}\" includes itself", file.string()), "take out this line");
  if (files_.size() >= most_files || open_.size() >= deepest)
    fail(place_,
         fmt::format("the deck includes more than {} files, or {} in each other", most_files, deepest));
  open(file);
}

Where InpLines::where(const InpPlace& place) const
{
  return {.file = files_[place.file].string(), .line = place.line};
}

std::string InpLines::required(const InpKeyword& keyword, std::string_view parameter) const
{
  const std::optional<std::string> value = keyword.find(parameter);
  if (!value || value->empty())
    fail(keyword.place, fmt::format("*{} without {}", keyword.name, parameter),
         fmt::format("*{}, {}=...", keyword.name, parameter));
  return *value;
}

double InpLines::number(std::string_view field, const InpPlace& place) const
{
  const std::optional<double> value = number_of(field);
  if (!value || !std::isfinite(*value))
    fail(place, fmt::format("\"{}\" is not a number", field.substr(0, 80)));
  return *value;
}

bool InpLines::read_line()
{
  Source& source = open_.back();
  if (source.position >= source.content.size()) return false;
  const std::string_view rest = std::string_view(source.content).substr(source.position);
  const std::size_t length = rest.find('\n');
  text_ = without_blanks(rest.substr(0, length));
  source.position += length == std::string_view::npos ? rest.size() : length + 1;
  place_ = {source.file, ++source.line};
  return true;
}

bool InpLines::next()
{
  const auto is_empty = [&] { return text_.empty() || text_.starts_with("**"); };
  while (true)
  {
    if (!read_line())
    {
      if (open_.size() == 1) return false;
      open_.pop_back();
      continue;
    }
    if (is_empty()) continue;
    if (!is_keyword() || text_.back() != ',') return true;
    joined_ = text_;
    const InpPlace begin = place_;
    while (joined_.back() == ',' && read_line())
      if (!is_empty()) joined_ += text_;
    text_ = joined_;
    place_ = begin;
    return true;
  }
}

InpKeyword InpLines::keyword() const
{
  InpKeyword result{.name = {}, .place = place_};
  std::string_view rest = text_.substr(1);
  bool is_name = true;
  while (true)
  {
    std::size_t end = 0;
    for (bool is_quoted = false; end < rest.size() && (is_quoted || rest[end] != ','); ++end)
      if (rest[end] == '"') is_quoted = !is_quoted;
    const std::string_view part = rest.substr(0, end);
    const std::size_t equals = part.find('=');
    if (is_name)
      result.name = keyword_name(part);
    else if (!without_blanks(part).empty())
    {
      std::string parameter = keyword_name(part.substr(0, equals));
      std::erase(parameter, ' ');
      result.parameters.emplace_back(
          parameter, equals == std::string_view::npos ? "" : trimmed(part.substr(equals + 1)));
    }
    is_name = false;
    if (end == rest.size()) return result;
    rest.remove_prefix(end + 1);
  }
}

std::span<const std::string_view> InpLines::fields()
{
  fields_.clear();
  std::string_view rest = text_;
  while (true)
  {
    const std::size_t comma = rest.find(',');
    fields_.push_back(trimmed(rest.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (fields_.back().empty()) fields_.pop_back();
  return fields_;
}

}  // namespace tribound::mesh
