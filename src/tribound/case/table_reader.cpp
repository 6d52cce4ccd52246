#include "tribound/case/table_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tribound::case_file
{

namespace
{

[[noreturn]] void fail_unknown_key(const Entry& entry, const std::vector<std::string>& keys,
                                   bool named_tables)
{
  const std::string near = closest(entry.name, keys);
  throw InputError(
      entry.where, "unknown key",
      fmt::format("{}allowed here: {}{}", near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                  fmt::join(keys, ", "), named_tables ? ", or tables of single regions" : ""));
}

std::string requirement(const Interval& interval)
{
  if (interval.lower == 0.0 && std::isinf(interval.upper))
    return interval.includes_lower ? "must not be negative" : "must be positive";
  return fmt::format("must lie in {}{}, {}{}", interval.includes_lower ? '[' : '(', interval.lower,
                     interval.upper, interval.includes_upper ? ']' : ')');
}

}  // namespace

TableReader::TableReader(const Node& node, std::span<const std::string_view> keys, Subtables subtables)
    : table_(std::get_if<Node::Table>(&node.value)),
      keys_(keys.begin(), keys.end()),
      subtables_(subtables),
      where_(node.where)
{
  if (table_ == nullptr)
    fail_type(node, "a table", fmt::format("a table with the keys {}", fmt::join(keys_, ", ")));
  for (const Entry& entry : *table_)
    if (!is_named(entry) && std::ranges::find(keys_, entry.name) == keys_.end())
      fail_unknown_key(entry, keys_, subtables_ == Subtables::named);
}

const Node* TableReader::find(std::string_view key) const
{
  assert(std::ranges::find(keys_, key) != keys_.end());
  const Entry* entry = case_file::find(*table_, key);
  return entry == nullptr || is_named(*entry) ? nullptr : &entry->node;
}

const Node& TableReader::require(std::string_view key, const std::string& hint) const
{
  if (const Node* node = find(key)) return *node;
  Where where = where_;
  where.key = dotted_key(where_.key, key);
  throw InputError(std::move(where), "is missing", hint);
}

std::vector<const Entry*> TableReader::named() const
{
  std::vector<const Entry*> entries;
  for (const Entry& entry : *table_)
    if (is_named(entry)) entries.push_back(&entry);
  return entries;
}

void refuse_keys_of_others(const TableReader& table, std::string_view what, std::span<const KeyGroup> groups,
                           std::size_t chosen)
{
  const KeyGroup& own = groups[chosen];
  for (const KeyGroup& group : groups)
    for (const std::string_view key : group.keys)
      if (const Node* node = table.find(key); node != nullptr && std::ranges::count(own.keys, key) == 0)
        throw InputError(node->where, fmt::format("does not belong to {} = \"{}\"", what, own.name),
                         fmt::format("it goes with {} = \"{}\"", what, group.name));
}

void fail_type(const Node& node, std::string_view expected, const std::string& hint)
{
  throw InputError(node.where, fmt::format("must be {}, found {}", expected, describe(node)), hint);
}

std::string to_text(const Node& node)
{
  const auto* text = std::get_if<std::string>(&node.value);
  if (text == nullptr) fail_type(node, "a string", "strings stand in quotes");
  if (text->find('\0') != std::string::npos)
    throw InputError(node.where, "holds the character \\u0000", "letters, digits and ordinary signs");
  return *text;
}

bool to_bool(const Node& node)
{
  const auto* truth = std::get_if<bool>(&node.value);
  if (truth == nullptr) fail_type(node, "true or false", "true or false without quotes");
  return *truth;
}

double to_number(const Node& node)
{
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*integer);
  const auto* number = std::get_if<double>(&node.value);
  if (number == nullptr) fail_type(node, "a number", "a number without quotes, such as 0.3");
  if (!std::isfinite(*number)) fail_type(node, "a finite number", "an ordinary number, such as 0.3");
  return *number;
}

problem::Field to_field(const Node& node)
{
  if (const auto* text = std::get_if<std::string>(&node.value)) return problem::Field(*text, node.where);
  if (!std::holds_alternative<std::int64_t>(node.value) && !std::holds_alternative<double>(node.value))
    fail_type(node, "a number or a formula", "such as 0.3 or \"0.3*max(0, 1-x)\"");
  const double number = to_number(node);
  if (std::abs(number) > reasonable.upper)
    throw InputError(node.where, fmt::format("is beyond all physics, {}", number),
                     "its square must be a number, too: take other units");
  return problem::Field(number, node.where);
}

problem::Field to_nonnegative_field(const Node& node)
{
  problem::Field field = to_field(node);
  if (field.is_constant() && field.constant() < 0)
    throw InputError(node.where, fmt::format("must not be negative, found {}", describe(node)),
                     problem::nonnegative_hint);
  return field;
}

const Node::Array& to_components(const Node& node, std::string_view what)
{
  const auto* array = std::get_if<Node::Array>(&node.value);
  if (array == nullptr || (array->size() != 2 && array->size() != 3))
    fail_type(node, "an array of 2 or 3", std::string(what));
  return *array;
}

std::vector<problem::Field> to_fields(const Node& node)
{
  std::vector<problem::Field> components;
  for (const Node& item : to_components(node, "one number or formula per dimension, such as [0, -1]"))
    components.push_back(to_field(item));
  return components;
}

std::vector<double> to_numbers(const Node& node, std::string_view what)
{
  std::vector<double> numbers;
  for (const Node& item : to_components(node, what)) numbers.push_back(to_number(item));
  return numbers;
}

std::vector<double> to_vector(const Node& node, std::string_view what, const std::string& hint)
{
  std::vector<double> vector = to_numbers(node, what);
  if (std::ranges::count(vector, 0.0) == std::ssize(vector))
    throw InputError(node.where, "has no length", hint);
  return vector;
}

std::vector<double> to_direction(const Node& node, const std::string& hint)
{
  if (const auto* text = std::get_if<std::string>(&node.value))
  {
    if (*text == "normal") return {};
    throw InputError(node.where, fmt::format("is \"{}\"", *text), hint);
  }
  return to_vector(node, "\"normal\" or one number per dimension", hint);
}

double to_number_in(const Node& node, const Interval& interval, const std::string& hint)
{
  const double number = to_number(node);
  const bool above = interval.includes_lower ? number >= interval.lower : number > interval.lower;
  const bool below = interval.includes_upper ? number <= interval.upper : number < interval.upper;
  if (!above || !below)
    throw InputError(node.where, fmt::format("{}, found {}", requirement(interval), number), hint);
  return number;
}

long to_integer_in(const Node& node, long lower, long upper, const std::string& hint)
{
  const auto* integer = std::get_if<std::int64_t>(&node.value);
  if (integer == nullptr) fail_type(node, "an integer", hint);
  if (*integer < lower || *integer > upper)
  {
    // The largest value of a type is a limit of the machine, not worth telling unless it is exceeded.
    const std::string range = *integer < lower && upper >= std::numeric_limits<int>::max()
                                  ? fmt::format("of at least {}", lower)
                                  : fmt::format("from {} to {}", lower, upper);
    throw InputError(node.where, fmt::format("must be an integer {}, found {}", range, *integer), hint);
  }
  return *integer;
}

std::size_t to_choice(const Node& node, const std::vector<std::string>& names)
{
  const std::string list = fmt::format("one of \"{}\"", fmt::join(names, "\", \""));
  const auto* text = std::get_if<std::string>(&node.value);
  if (text == nullptr) fail_type(node, "a string", list);
  const auto it = std::ranges::find(names, *text);
  if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
  const std::string near = closest(*text, names);
  throw InputError(node.where, fmt::format("unknown value \"{}\"", *text),
                   near.empty() ? list : fmt::format("did you mean \"{}\"? {}", near, list));
}

}  // namespace tribound::case_file
