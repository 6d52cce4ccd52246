#include "tribound/case/node.h"

#include <fmt/format.h>

#include <algorithm>

namespace tribound::case_file
{

namespace
{

bool is_bare_key(std::string_view name)
{
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !name.empty() && name.find_first_not_of(allowed) == std::string_view::npos;
}

struct Describe
{
  std::string operator()(const Node::Table&) const { return "a table"; }
  std::string operator()(const Node::Array& array) const
  {
    return array.empty() ? "an empty array" : fmt::format("an array of {}", array.size());
  }
  std::string operator()(const std::string& text) const { return fmt::format("the string \"{}\"", text); }
  std::string operator()(std::int64_t integer) const { return fmt::format("the integer {}", integer); }
  std::string operator()(double number) const { return fmt::format("the number {}", number); }
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(Node::DateOrTime) const { return "a date or time"; }
  std::string operator()(const problem::FieldFunction&) const { return "a function"; }
};

}  // namespace

const Entry* find(const Node::Table& table, std::string_view name)
{
  const auto it = std::ranges::find(table, name, &Entry::name);
  return it == table.end() ? nullptr : &*it;
}

Entry* find(Node::Table& table, std::string_view name)
{
  const auto it = std::ranges::find(table, name, &Entry::name);
  return it == table.end() ? nullptr : &*it;
}

std::string describe(const Node& node)
{
  return std::visit(Describe{}, node.value);
}

std::string dotted_key(const std::string& table, std::string_view name)
{
  const std::string part = is_bare_key(name) ? std::string(name) : fmt::format("\"{}\"", name);
  return table.empty() ? part : table + "." + part;
}

}  // namespace tribound::case_file
