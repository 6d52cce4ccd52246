#include "tribound/case/sweep_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "tribound/base/error.h"
#include "tribound/case/node.h"

namespace tribound::case_file
{

namespace
{

constexpr auto hint = "key=0.1:0.8:8 (first, last, how many), key=[1, 2] or key=value";
constexpr int max_runs = 100'000;

std::string without_blanks(std::string_view text)
{
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// The number that makes up the whole text.
double number(const std::string& text, const Where& where)
{
  const char* const begin = text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value))
    throw InputError(where, fmt::format("\"{}\" is no finite number", text), hint);
  return value;
}

/// The three parts of "0.1:0.8:8", which contain only characters of numbers; empty for any other text.
std::vector<std::string> parts_of_range(const std::string& text)
{
  const std::size_t first = text.find(':');
  const std::size_t second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second == std::string::npos) return {};
  std::vector<std::string> parts = {text.substr(0, first), text.substr(first + 1, second - first - 1),
                                    text.substr(second + 1)};
  for (const std::string& part : parts)
    if (part.empty() || part.find_first_not_of("-+.eE0123456789") != std::string::npos) return {};
  return parts;
}

/// "0.1:0.8:8" as eight numbers; steps of decimal fractions come out as decimal fractions.
std::vector<std::string> range(std::span<const std::string> parts, const Where& where)
{
  const double first = number(parts[0], where);
  const double last = number(parts[1], where);
  const double n = number(parts[2], where);
  if (n < 2 || n > max_runs || n != std::floor(n))
    throw InputError(where, fmt::format("cannot make {} values from {} to {}", parts[2], parts[0], parts[1]),
                     "finite ends and at least 2 values");
  std::vector<std::string> values;
  values.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    values.push_back(fmt::format("{:.15g}", first + (last - first) * (i / (n - 1))));
  return values;
}

std::vector<std::string> values_of(const std::string& text, const Where& where)
{
  if (const auto parts = parts_of_range(without_blanks(text)); !parts.empty()) return range(parts, where);
  if (text.find_first_not_of(' ') == std::string::npos) throw InputError(where, "there is no value", hint);
  if (text[text.find_first_not_of(' ')] != '[') return {text};
  try
  {
    const Node document = parse_toml("values = " + text, where.file);
    std::vector<std::string> values;
    for (const Node& item :
         std::get<Node::Array>(find(std::get<Node::Table>(document.value), "values")->node.value))
      values.push_back(to_inline_toml(item));
    if (values.empty()) throw InputError(where, "there is no value", hint);
    return values;
  }
  catch (const InputError& error)
  {
    throw InputError(
        where, error.problem(),
        "words and formulas in an array stand in quotes, as in " + std::string(R"('key=["x", "2*x"]')"));
  }
}

void check_keys(const std::vector<std::string>& keys, const std::string& file)
{
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    if (keys[i].empty()) throw InputError({.file = file}, "a key is missing", hint);
    if (std::find(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(i), keys[i]) !=
        keys.begin() + static_cast<std::ptrdiff_t>(i))
      throw InputError({.file = file}, fmt::format("\"{}\" is swept twice", keys[i]), "keep one of the two");
  }
}

}  // namespace

std::vector<std::vector<std::string>> parse_csv(std::string_view text, const std::string& file)
{
  const auto fail = [&](std::size_t at, const std::string& problem)
  {
    const auto line = static_cast<int>(std::count(text.begin(), text.begin() + at, '\n')) + 1;
    throw InputError({.file = file, .line = line}, problem, "\"\" stands for a quote in a quoted cell");
  };
  std::size_t opened = 0;
  std::vector<std::vector<std::string>> lines(1);
  std::string cell;
  bool quoted = false;
  bool was_quoted = false;
  const auto end_cell = [&]
  {
    lines.back().push_back(was_quoted ? cell : without_blanks(cell));
    cell.clear();
    was_quoted = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
      cell += text[i++];
    else if (c == '"' && (quoted || without_blanks(cell).empty()))
    {
      if (!quoted && was_quoted) fail(i, "a quote follows a cell that has ended");
      if (!quoted) opened = i;
      if (!quoted) cell.clear();
      quoted = !quoted;
      was_quoted = true;
    }
    else if (c == ',' && !quoted)
      end_cell();
    else if (c == '\n' && !quoted)
    {
      end_cell();
      lines.emplace_back();
    }
    else if (!was_quoted || quoted)
      cell += c;
    else if (c != ' ' && c != '\t' && c != '\r')
      fail(i, "something follows the quote that ends a cell");
  }
  if (quoted) fail(opened, "a quote is not closed");
  if (!cell.empty() || was_quoted || !lines.back().empty()) end_cell();
  std::erase_if(lines,
                [](const auto& line) { return line.empty() || (line.size() == 1 && line[0].empty()); });
  return lines;
}

SweepTable sweep_grid(std::span<const std::string> assignments)
{
  SweepTable table;
  table.rows = {{}};
  for (const std::string& assignment : assignments)
  {
    const Where where{.file = assignment};
    const auto [key, value] = split_assignment(assignment, where, hint);
    table.keys.push_back(without_blanks(key));
    const std::vector<std::string> values = values_of(value, where);
    if (table.rows.size() * values.size() > max_runs)
      throw InputError(where, fmt::format("makes more than {} runs", max_runs), "take fewer values");
    std::vector<std::vector<std::string>> rows;
    for (const auto& row : table.rows)
      for (const std::string& value : values)
      {
        rows.push_back(row);
        rows.back().push_back(value);
      }
    table.rows = std::move(rows);
  }
  check_keys(table.keys, "tribound sweep");
  return table;
}

SweepTable sweep_rows(std::string_view csv, const std::string& file)
{
  std::vector<std::vector<std::string>> lines = parse_csv(csv, file);
  if (lines.size() < 2)
    throw InputError({.file = file}, "holds no run", "a line of keys, then a line of values for each run");
  SweepTable table;
  table.keys = std::move(lines.front());
  check_keys(table.keys, file);
  for (std::size_t i = 1; i < lines.size(); ++i)
  {
    if (lines[i].size() != table.keys.size() || std::ranges::count(lines[i], "") > 0)
      throw InputError({.file = file},
                       fmt::format("run {} has {} values for {} keys", i,
                                   lines[i].size() - std::ranges::count(lines[i], ""), table.keys.size()),
                       "a value for every key; one that holds a comma stands in quotes");
    table.rows.push_back(std::move(lines[i]));
  }
  return table;
}

}  // namespace tribound::case_file
