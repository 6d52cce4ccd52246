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

std::vector<std::string> key_names(const Table& table)
{
  std::vector<std::string> all;
  for (const Key& key : table.keys) all.push_back(key.name);
  return all;
}

[[noreturn]] void fail_unknown_key(const Entry& entry, const Table& table)
{
  const std::vector<std::string> keys = key_names(table);
  const std::string near = closest(entry.name, keys);
  throw InputError(
      entry.where, "unknown key",
      fmt::format("{}allowed here: {}{}", near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                  fmt::join(keys, ", "), table.named ? ", or tables of single regions" : ""));
}

std::string requirement(const Interval& interval)
{
  if (interval.lower == 0.0 && std::isinf(interval.upper))
    return interval.includes_lower ? "must not be negative" : "must be positive";
  return fmt::format("must lie in {}{}, {}{}", interval.includes_lower ? '[' : '(', interval.lower,
                     interval.upper, interval.includes_upper ? ']' : ')');
}

}  // namespace

TableReader::TableReader(const Node& node, const Table& table)
    : entries_(std::get_if<Node::Table>(&node.value)), shape_(table), where_(node.where)
{
  if (entries_ == nullptr)
    fail_type(node, "a table", fmt::format("a table with the keys {}", fmt::join(key_names(table), ", ")));
  for (const Entry& entry : *entries_)
    if (!is_named(entry) && std::ranges::count(table.refused.keys, entry.name) > 0)
      throw InputError(entry.where, table.refused.problem, table.refused.hint);
  for (const Entry& entry : *entries_)
    if (!is_named(entry) && std::ranges::find(table.keys, entry.name, &Key::name) == table.keys.end())
      fail_unknown_key(entry, table);
}

const Key& TableReader::key_of(std::string_view key) const
{
  const auto found = std::ranges::find(shape_.keys, key, &Key::name);
  assert(found != shape_.keys.end());
  return *found;
}

const Node* TableReader::find(std::string_view key) const
{
  (void)key_of(key);
  const Entry* entry = case_file::find(*entries_, key);
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
  for (const Entry& entry : *entries_)
    if (is_named(entry)) entries.push_back(&entry);
  return entries;
}

std::string TableReader::only(const std::string& hint, std::string_view beside) const
{
  std::string given;
  for (const std::string& key : shape_.one_of)
  {
    const Node* node = find(key);
    if (node == nullptr) continue;
    if (!given.empty())
      throw InputError(node->where, fmt::format("{} stands beside {}", key, beside.empty() ? given : beside),
                       hint);
    given = key;
  }
  return given;
}

const Node* TableReader::excluded_by(std::string_view key) const
{
  if (!has(key)) return nullptr;
  const auto relation = std::ranges::find(shape_.relations, key, &Relation::key);
  assert(relation != shape_.relations.end());
  for (const std::string& other : relation->excludes)
    if (const Node* node = find(other)) return node;
  return nullptr;
}

std::size_t TableReader::choose() const
{
  const Key& choice = key_of(shape_.choice);
  const Node* given = choice.missing.empty() ? find(choice.name) : &require(choice.name);
  const std::size_t chosen = given == nullptr ? 0 : to_choice(*given, choice.value.words);
  const KeyGroup& own = shape_.groups[chosen];
  for (const KeyGroup& group : shape_.groups)
    for (const std::string& key : group.keys)
      if (const Node* node = find(key); node != nullptr && std::ranges::count(own.keys, key) == 0)
        throw InputError(node->where, fmt::format("does not belong to {} = \"{}\"", choice.name, own.word),
                         fmt::format("it goes with {} = \"{}\"", choice.name, group.word));
  return chosen;
}

void TableReader::require_group(std::size_t chosen) const
{
  for (const std::string& key : shape_.groups[chosen].required) (void)require(key, key_of(key).value.hint);
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
  if (const auto* function = std::get_if<problem::FieldFunction>(&node.value))
    return problem::Field(*function, node.where);
  if (!std::holds_alternative<std::int64_t>(node.value) && !std::holds_alternative<double>(node.value))
    fail_type(node, "a number or a formula", "such as 0.3 or \"0.3*max(0, 1-x)\"");
  const double number = to_number(node);
  if (std::abs(number) > reasonable.upper)
    throw InputError(node.where, fmt::format("is too large to compute with: {}", number),
                     "its square must be a number, too: take other units");
  return problem::Field(number, node.where);
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
    // The largest value of a type is a limit of the machine; it is only mentioned when exceeded.
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

std::span<const Node> to_items(const Node& node, const Value& value)
{
  const auto* array = std::get_if<Node::Array>(&node.value);
  if (array == nullptr && value.text)
  {
    if (!std::holds_alternative<std::string>(node.value)) fail_type(node, "a string or an array", value.hint);
    return {&node, 1};
  }
  if (array == nullptr || array->size() > value.most || (array->size() < value.least && value.least > 1))
    fail_type(node,
              value.least < 2   ? "an array"
              : value.most == 3 ? "an array of 2 or 3"
                                : fmt::format("an array of {} or more", value.least),
              value.hint);
  if (array->size() < value.least) throw InputError(node.where, "is empty", value.hint);
  return *array;
}

bool is_word(const Node& node, const Value& value)
{
  const auto* word = std::get_if<std::string>(&node.value);
  if (word == nullptr || value.words.empty()) return false;
  if (std::ranges::find(value.words, *word) != value.words.end()) return true;
  if (!value.text) throw InputError(node.where, fmt::format("is \"{}\"", *word), value.hint);
  return false;
}

void convert(const Node& node, const Value& /*value*/, bool& target)
{
  const auto* truth = std::get_if<bool>(&node.value);
  if (truth == nullptr) fail_type(node, "true or false", "true or false without quotes");
  target = *truth;
}

void convert(const Node& node, const Value& value, double& target)
{
  target = to_number_in(node, *value.number, value.hint);
}

void convert(const Node& node, const Value& value, std::string& target)
{
  target = value.text ? to_text(node) : value.words[to_choice(node, value.words)];
  if (target.size() < value.least) throw InputError(node.where, "is empty", value.hint);
}

void convert(const Node& node, const Value& value, std::filesystem::path& target)
{
  std::string path;
  convert(node, value, path);
  target = path;
}

void convert(const Node& node, const Value& value, problem::Field& target)
{
  target = to_field(node);
  if (value.number->lower == 0 && target.is_constant() && target.constant() < 0)
    throw InputError(node.where, fmt::format("must not be negative, found {}", describe(node)),
                     problem::nonnegative_hint);
}

}  // namespace tribound::case_file
