#include "tribound/case/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

namespace
{

constexpr auto hint = "a number: [parameters] mu = 0.3, or mu = { value = 0.3, label = \"friction\" }";

bool is_letter(char c)
{
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_digit(char c)
{
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Where the name or number that begins at i ends; i + 1 for any other character.
std::size_t end_of_token(const std::string& text, std::size_t i)
{
  std::size_t end = i + 1;
  if (is_letter(text[i]))
    while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
  else if (is_digit(text[i]) || text[i] == '.')
    while (end < text.size() &&
           (is_letter(text[end]) || is_digit(text[end]) || text[end] == '.' ||
            ((text[end] == '-' || text[end] == '+') && std::tolower(text[end - 1]) == 'e')))
      ++end;
  return end;
}

Value parameter_value()
{
  Value value = number_in({.includes_lower = true}, hint);
  value.is_literal = true;
  return value;
}

const Table& parameter_table()
{
  static const Table table{.name = "parameters.NAME",
                           .keys = {{"value", parameter_value(), hint}, {"label", text()}, {"unit", text()}}};
  return table;
}

/// Whether a formula gives the name a meaning of its own.
bool is_known_to_formulas(const std::string& name)
{
  for (const std::string& formula : {name, name + "(1)", name + "(1, 1)", name + "(1, 1, 1)"}) try
    {
      (void)problem::Field(formula, Where{});
      return true;
    }
    catch (const InputError&)
    {
    }
  return false;
}

void check_name(const Entry& entry)
{
  const std::string& name = entry.name;
  if (name.empty() || end_of_token(name, 0) != name.size() || !is_letter(name[0]))
    throw InputError(entry.where, "is no name for formulas", "letters, digits and _, a letter first");
  if (is_known_to_formulas(name))
    throw InputError(entry.where, fmt::format("formulas give \"{}\" another meaning", name),
                     "another name, such as " + name + "_1");
}

/// Puts values in place of names.
class Replacement
{
 public:
  explicit Replacement(std::span<const Parameter> parameters) : parameters_(parameters) {}

  void in(Node& node, const Value& value)
  {
    if (auto* string = std::get_if<std::string>(&node.value))
      in_string(*string, node, value);
    else if (auto* array = std::get_if<Node::Array>(&node.value))
      for (Node& item : *array)
      {
        if (!value.items.empty()) in(item, value.items.front());
      }
    else if (auto* table = std::get_if<Node::Table>(&node.value); table && value.table != nullptr)
      in(*table, *value.table);
  }

  void in(Node::Table& table, const Table& shape)
  {
    for (Entry& entry : table)
    {
      const auto key = std::ranges::find(shape.keys, entry.name, &Key::name);
      if (key != shape.keys.end())
        in(entry.node, key->value);
      else if (shape.named)
        in(entry.node, *shape.named);
    }
  }

  [[nodiscard]] bool has_used(const std::string& name) const { return used_.contains(name); }

 private:
  void in_string(const std::string& text, Node& node, const Value& value)
  {
    const bool is_number = value.number && !value.text;
    if (!(value.is_formula || is_number) || std::ranges::find(value.words, text) != value.words.end()) return;
    const std::string replaced = this->replaced(text);
    if (replaced == text) return;
    if (is_number)
      set_number(replaced, node, value);
    else
      node.value = replaced;
  }

  void set_number(const std::string& text, Node& node, const Value& value) const
  {
    const problem::Field field(text, node.where);
    if (!field.is_constant() || field.uses_time())
      throw InputError(node.where, "must be a number, found a formula of more than parameters", value.hint);
    const double number = field.constant();
    if (value.is_integer && number == std::floor(number) && std::abs(number) < 1e15)
      node.value = static_cast<std::int64_t>(number);
    else
      node.value = number;
  }

  std::string replaced(const std::string& text)
  {
    std::string result;
    for (std::size_t i = 0; i < text.size();)
    {
      const std::size_t end = end_of_token(text, i);
      const std::string token = text.substr(i, end - i);
      const auto parameter = std::ranges::find(parameters_, token, &Parameter::name);
      if (parameter == parameters_.end())
        result += token;
      else
      {
        result += fmt::format("({})", parameter->value);
        used_.insert(parameter->name);
      }
      i = end;
    }
    return result;
  }

  std::span<const Parameter> parameters_;
  std::set<std::string> used_;
};

const Entry* parameters_of(const Node& document)
{
  return find(std::get<Node::Table>(document.value), "parameters");
}

}  // namespace

const Table& parameters_table()
{
  static const Table table{.name = "parameters", .named = parameter_value() | keys_of(parameter_table())};
  return table;
}

std::vector<Parameter> read_parameters(const Node& document)
{
  std::vector<Parameter> parameters;
  const Entry* given = parameters_of(document);
  if (given == nullptr) return parameters;
  const auto* table = std::get_if<Node::Table>(&given->node.value);
  if (table == nullptr) fail_type(given->node, "a table", hint);
  for (const Entry& entry : *table)
  {
    check_name(entry);
    Parameter& parameter = parameters.emplace_back(Parameter{.name = entry.name});
    if (!entry.node.is_table())
    {
      parameter.value = to_number_in(entry.node, finite, hint);
      continue;
    }
    const TableReader reader(entry.node, parameter_table());
    parameter.value = reader.get<double>("value");
    reader.read("label", parameter.label);
    reader.read("unit", parameter.unit);
  }
  return parameters;
}

Node with_values(Node document, const std::vector<Parameter>& parameters)
{
  if (parameters.empty()) return document;
  Replacement replacement(parameters);
  auto& tables = std::get<Node::Table>(document.value);
  const auto entry = std::ranges::find(tables, "parameters", &Entry::name);
  const auto& given = std::get<Node::Table>(entry->node.value);
  replacement.in(tables, case_table());
  for (const Entry& parameter : given)
    if (!replacement.has_used(parameter.name))
      throw InputError(parameter.where, "nothing uses this parameter",
                       fmt::format("a formula or number such as \"{}\", or drop it", parameter.name));
  return document;
}

std::string parameter_assignment(const Node& document, const std::string& assignment)
{
  const Entry* given = parameters_of(document);
  const auto* table = given == nullptr ? nullptr : std::get_if<Node::Table>(&given->node.value);
  const std::size_t end = assignment.find('=');
  if (table == nullptr || end == std::string::npos) return assignment;
  const Entry* parameter = find(*table, assignment.substr(0, end));
  if (parameter == nullptr) return assignment;
  return "parameters." + parameter->name + (parameter->node.is_table() ? ".value" : "") +
         assignment.substr(end);
}

}  // namespace tribound::case_file
