#pragma once

/// @file node.h
/// A case as a tree of values with their positions: a TOML document, independent of the TOML library, or made
/// by a program, which may put functions in the place of formulas.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/problem/field.h"

namespace tribound::case_file
{

struct Entry;

/// A value and its position: line and column of the value itself, key with all enclosing tables.
struct Node
{
  using Table = std::vector<Entry>;  ///< in the order of the document
  using Array = std::vector<Node>;
  /// TOML has dates and times; no key of a case takes one.
  struct DateOrTime
  {
  };

  std::variant<Table, Array, std::string, std::int64_t, double, bool, DateOrTime, problem::FieldFunction>
      value;
  Where where;

  [[nodiscard]] bool is_table() const { return std::holds_alternative<Table>(value); }
};

/// A key of a table.
struct Entry
{
  std::string name;
  Where where;  ///< of the key
  Node node;
};

/// The entry of that name, or null.
[[nodiscard]] const Entry* find(const Node::Table& table, std::string_view name);
[[nodiscard]] Entry* find(Node::Table& table, std::string_view name);

/// A description for messages: "the string \"abc\"", "the integer 5", "an array of 2", "a table".
[[nodiscard]] std::string describe(const Node& node);

/// "table.name", with the name quoted where TOML requires it.
[[nodiscard]] std::string dotted_key(const std::string& table, std::string_view name);

/// Parses a TOML document; messages give `file` for it. Throws InputError with line and column.
[[nodiscard]] Node parse_toml(std::string_view text, const std::string& file);

/// The document as TOML that parse_toml() reads back to the same values: first the keys of a table, then its
/// subtables, each with a header. Numbers have the fewest digits that read back as the same number. A
/// function becomes a string that is no formula: such a case cannot be read back.
[[nodiscard]] std::string to_toml(const Node& document);

/// A value as written after "key = ".
[[nodiscard]] std::string to_inline_toml(const Node& node);

/// "key" and "value" of "key=value", split at the first "=" outside quotes. Throws InputError with the hint.
[[nodiscard]] std::pair<std::string, std::string> split_assignment(const std::string& assignment,
                                                                   const Where& where,
                                                                   const std::string& hint);

/// Applies one "dotted.key=TOML value" to the document: adds the key or replaces its value. A bare word that
/// is no TOML value counts as a string. Throws InputError.
void apply_override(Node& document, const std::string& assignment);

}  // namespace tribound::case_file
