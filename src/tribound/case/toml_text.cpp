#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "tribound/case/node.h"

namespace tribound::case_file
{

namespace
{

/// A basic string of TOML.
std::string quoted(std::string_view text)
{
  std::string result = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      result += c;
  return result + "\"";
}

/// The name of a key, quoted where necessary.
std::string key_text(const std::string& name)
{
  return dotted_key({}, name) == name ? name : quoted(name);
}

struct InlineText
{
  std::string operator()(const Node::Table& table) const
  {
    std::string text;
    for (const Entry& entry : table)
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key_text(entry.name),
                          to_inline_toml(entry.node));
    return text.empty() ? "{}" : "{ " + text + " }";
  }
  std::string operator()(const Node::Array& array) const
  {
    std::string text;
    for (const Node& item : array) text += (text.empty() ? "" : ", ") + to_inline_toml(item);
    return "[" + text + "]";
  }
  std::string operator()(const std::string& text) const { return quoted(text); }
  std::string operator()(std::int64_t integer) const { return fmt::format("{}", integer); }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(Node::DateOrTime) const
  {
    assert(false);  // no key of a case accepts one
    return {};
  }
  std::string operator()(const problem::FieldFunction&) const { return quoted("a function of a program"); }
};

/// Whether it is written as one [[name]] per item.
bool is_array_of_tables(const Node& node)
{
  const auto* items = std::get_if<Node::Array>(&node.value);
  return items != nullptr && !items->empty() && std::ranges::all_of(*items, &Node::is_table);
}

/// Writes the keys of the table with their values, then its subtables.
void append(std::string& text, const Node::Table& table, const std::string& name)
{
  for (const Entry& entry : table)
    if (!entry.node.is_table() && !is_array_of_tables(entry.node))
      text += fmt::format("{} = {}\n", key_text(entry.name), to_inline_toml(entry.node));
  for (const Entry& entry : table)
  {
    const std::string inner = name + (name.empty() ? "" : ".") + key_text(entry.name);
    if (is_array_of_tables(entry.node))
      for (const Node& item : std::get<Node::Array>(entry.node.value))
      {
        text += fmt::format("{}[[{}]]\n", text.empty() ? "" : "\n", inner);
        append(text, std::get<Node::Table>(item.value), inner);
      }
    if (entry.node.is_table())
    {
      const auto& content = std::get<Node::Table>(entry.node.value);
      if (content.empty() || !std::ranges::all_of(content, [](const Entry& e) { return e.node.is_table(); }))
        text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", inner);
      append(text, content, inner);
    }
  }
}

}  // namespace

std::string to_inline_toml(const Node& node)
{
  return std::visit(InlineText{}, node.value);
}

std::string to_toml(const Node& document)
{
  std::string text;
  append(text, std::get<Node::Table>(document.value), {});
  return text;
}

}  // namespace tribound::case_file
