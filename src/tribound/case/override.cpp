#include <fmt/format.h>

#include <cassert>
#include <charconv>
#include <limits>
#include <string_view>
#include <utility>

#include "tribound/case/node.h"

namespace tribound::case_file
{

namespace
{

/// The entry set by a document of the form "a.b.c = value", and the number of enclosing tables.
std::pair<Entry*, int> leaf(Node& document, int max_depth)
{
  auto* table = &std::get<Node::Table>(document.value);
  for (int depth = 0;; ++depth)
  {
    assert(table->size() == 1);
    Entry& entry = table->front();
    if (depth == max_depth || !entry.node.is_table()) return {&entry, depth};
    table = &std::get<Node::Table>(entry.node.value);
  }
}

/// Sets the override itself as the file; line and column are meaningless there.
void set_place(Node& node, const std::string& file)
{
  const auto move_to_file = [&](Where& where)
  {
    where.file = file;
    where.line = where.column = 0;
  };
  move_to_file(node.where);
  if (auto* array = std::get_if<Node::Array>(&node.value))
    for (Node& item : *array) set_place(item, file);
  if (auto* table = std::get_if<Node::Table>(&node.value))
    for (Entry& entry : *table)
    {
      move_to_file(entry.where);
      set_place(entry.node, file);
    }
}

/// Whether the text may be an unquoted string.
bool is_bare_word(std::string_view text)
{
  return !text.empty() && std::string_view("\"'[{").find(text.front()) == std::string_view::npos;
}

std::string_view trimmed(std::string_view text)
{
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// A document with only this key, and the number of enclosing tables.
std::pair<Node, int> parse_assignment(const std::string& assignment, const Where& where)
{
  if (assignment.find_first_of("\r\n") != std::string::npos)
    throw InputError(where, "holds a line break", "one --set for each key");
  const auto [key, value] =
      split_assignment(assignment, where, "--set key=value, such as --set adapt.tolerance=0.02");
  Node with_zero;
  try
  {
    with_zero = parse_toml(key + " = 0", where.file);
  }
  catch (const InputError&)
  {
    throw InputError(where, fmt::format("\"{}\" is not a key", trimmed(key)),
                     "dotted names, quoted where they hold other characters than letters, digits, _ and -");
  }
  const std::string_view text = trimmed(value);
  if (text.empty()) throw InputError(where, "there is no value behind \"=\"", "an empty string is \"\"");
  const auto [entry, depth] = leaf(with_zero, std::numeric_limits<int>::max());
  try
  {
    Node document = parse_toml(key + " = " + value, where.file);
    const Entry* parsed = leaf(document, depth).first;
    entry->node.value = parsed->node.value;
  }
  catch (const InputError& error)
  {
    if (!is_bare_word(text)) throw InputError(where, error.problem(), error.hint());
    entry->node.value = std::string(text);
  }
  set_place(with_zero, where.file);
  return {std::move(with_zero), depth};
}

/// The array item named by a key such as 0.
Node& item_of(Node::Array& items, const Entry& entry, const Where& array)
{
  std::size_t number = 0;
  const char* end = entry.name.data() + entry.name.size();
  if (const auto [stop, error] = std::from_chars(entry.name.data(), end, number);
      error != std::errc{} || stop != end || number >= items.size())
    throw InputError(
        entry.where,
        fmt::format("{} is an array of {}, where \"{}\" is no item", array.key, items.size(), entry.name),
        fmt::format("{}.0 is the first item", array.key));
  return items[number];
}

/// Merges `entry`, which has one table per level with one key each down to `depth`, into `table`.
void merge(Node::Table& table, Entry& entry, int depth)
{
  Entry* existing = find(table, entry.name);
  if (existing == nullptr)
    table.push_back(std::move(entry));
  else if (depth == 0)
    *existing = std::move(entry);
  else if (existing->node.is_table())
    merge(std::get<Node::Table>(existing->node.value), std::get<Node::Table>(entry.node.value).front(),
          depth - 1);
  else if (auto* items = std::get_if<Node::Array>(&existing->node.value))
  {
    Entry& inner = std::get<Node::Table>(entry.node.value).front();
    Node& item = item_of(*items, inner, existing->where);
    if (depth > 1 && item.is_table())
      merge(std::get<Node::Table>(item.value), std::get<Node::Table>(inner.node.value).front(), depth - 2);
    else
      item = std::move(inner.node);
  }
  else
  {
    const Node& inner = std::get<Node::Table>(entry.node.value).front().node;
    throw InputError(inner.where,
                     fmt::format("{} is {}, not a table", existing->where.key, describe(existing->node)),
                     "override the whole key instead");
  }
}

}  // namespace

std::pair<std::string, std::string> split_assignment(const std::string& assignment, const Where& where,
                                                     const std::string& hint)
{
  char quote = 0;
  for (std::size_t i = 0; i < assignment.size(); ++i)
  {
    const char c = assignment[i];
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '=')
      return {assignment.substr(0, i), assignment.substr(i + 1)};
  }
  throw InputError(where, "there is no \"=\"", hint);
}

void apply_override(Node& document, const std::string& assignment)
{
  auto [parsed, depth] = parse_assignment(assignment, {.file = "--set " + assignment});
  merge(std::get<Node::Table>(document.value), std::get<Node::Table>(parsed.value).front(), depth);
}

}  // namespace tribound::case_file
