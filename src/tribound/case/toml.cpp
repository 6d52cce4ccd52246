#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

#include "tribound/case/node.h"

namespace tribound::case_file
{

namespace
{

Where place(const toml::source_position& position, const std::string& file, std::string key)
{
  return {file, std::move(key), static_cast<int>(position.line), static_cast<int>(position.column)};
}

Node convert(const toml::node& source, const std::string& file, const std::string& key)
{
  Node node;
  node.where = place(source.source().begin, file, key);
  if (const auto* table = source.as_table())
  {
    Node::Table entries;
    for (const auto& [name, value] : *table)
    {
      const std::string full_key = dotted_key(key, name.str());
      entries.push_back({std::string(name.str()), place(name.source().begin, file, full_key),
                         convert(value, file, full_key)});
    }
    // toml++ sorts by name; messages and results should follow the order of the file.
    std::ranges::stable_sort(entries, {},
                             [](const Entry& e) { return std::tuple(e.where.line, e.where.column); });
    node.value = std::move(entries);
  }
  else if (const auto* array = source.as_array())
  {
    Node::Array items;
    for (const toml::node& item : *array)
      items.push_back(convert(item, file, fmt::format("{}[{}]", key, items.size())));
    node.value = std::move(items);
  }
  else if (const auto* text = source.as_string())
    node.value = text->get();
  else if (const auto* integer = source.as_integer())
    node.value = integer->get();
  else if (const auto* number = source.as_floating_point())
    node.value = number->get();
  else if (const auto* truth = source.as_boolean())
    node.value = truth->get();
  else
    node.value = Node::DateOrTime{};
  return node;
}

/// Extracts the key: toml++ says "cannot redefine existing table 'boundary.left'" within a longer sentence.
std::string redefined_key(std::string_view description)
{
  if (description.find("cannot redefine") == std::string_view::npos) return {};
  const std::size_t begin = description.find('\'', description.find("cannot redefine"));
  const std::size_t end = description.find('\'', begin + 1);
  if (begin == std::string_view::npos || end == std::string_view::npos) return {};
  return std::string(description.substr(begin + 1, end - begin - 1));
}

[[noreturn]] void report(const toml::parse_error& error, const std::string& file)
{
  const std::string key = redefined_key(error.description());
  const Where where = place(error.source().begin, file, key);
  if (key.starts_with("boundary."))
    throw InputError(where, fmt::format("boundary \"{}\" is given twice", key.substr(9)),
                     "put all that holds on a boundary into one table");
  if (!key.empty()) throw InputError(where, "is given twice", "keep one of the two");
  throw InputError(
      where, fmt::format("not valid TOML: {}", error.description()),
      "strings and formulas stand in quotes, arrays in [ ], tables in { } or below a [header]; see toml.io");
}

/// Limit on dots in a key and on open brackets. toml++ recurses on both, as does convert(); a case needs 4.
constexpr int deepest = 20;

/// Scans a document without a parser; only text outside strings and comments counts.
class DepthCheck
{
 public:
  DepthCheck(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void run()
  {
    while (position_ < text_.size()) step();
  }

 private:
  void step()
  {
    const char c = text_[position_];
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '#') return skip_to(text_.find('\n', position_));
    if (c == '.') count(dots_);
    if (c == '[' || c == '{') count(open_);
    if ((c == ']' || c == '}') && open_ > 0) --open_;
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) dots_ = 0;
    advance();
  }

  void count(int& depth)
  {
    if (++depth <= deepest) return;
    throw InputError(Where{file_, {}, line_, static_cast<int>(position_ - line_begin_) + 1},
                     fmt::format("tables or arrays are nested more than {} deep", deepest),
                     "a case needs no more than 4, as in boundary.top.contact.gap");
  }

  void advance()
  {
    if (text_[position_++] != '\n') return;
    ++line_;
    line_begin_ = position_;
  }

  void skip_to(std::size_t end)
  {
    while (position_ < std::min(end, text_.size())) advance();
  }

  /// An unterminated string is left to the parser.
  void skip_string(char quote)
  {
    const bool is_multiline = text_.substr(position_, 3) == std::string(3, quote);
    const std::string end = is_multiline ? std::string(3, quote) : std::string(1, quote);
    skip_to(position_ + end.size());
    while (position_ < text_.size() && text_.substr(position_, end.size()) != end)
    {
      if (!is_multiline && text_[position_] == '\n') return;
      skip_to(position_ + (quote == '"' && text_[position_] == '\\' ? 2 : 1));
    }
    skip_to(position_ + end.size());
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t position_ = 0;
  std::size_t line_begin_ = 0;
  int line_ = 1;
  int open_ = 0;  ///< open brackets
  int dots_ = 0;  ///< in the current key so far
};

}  // namespace

Node parse_toml(std::string_view text, const std::string& file)
{
  DepthCheck(text, file).run();
  try
  {
    return convert(toml::parse(text, file), file, {});
  }
  catch (const toml::parse_error& error)
  {
    report(error, file);
  }
}

}  // namespace tribound::case_file
