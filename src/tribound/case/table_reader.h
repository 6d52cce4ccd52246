#pragma once

/// @file table_reader.h
/// Typed, checked access to the tables of a case file. Every function throws InputError that says where the
/// value stands, what is wrong with it and what would be right.

#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/case/node.h"
#include "tribound/problem/field.h"

namespace tribound::case_file
{

/// A table whose keys are known to be allowed.
class TableReader
{
 public:
  /// Whether tables inside are keys like the others, or are named by the user ([material.<region>]).
  enum class Subtables
  {
    keys,
    named
  };

  /// Checks that `node` is a table and that its keys are among `keys`. Keeps a reference to the node.
  TableReader(const Node& node, std::span<const std::string_view> keys,
              Subtables subtables = Subtables::keys);
  TableReader(const Node& node, std::initializer_list<std::string_view> keys,
              Subtables subtables = Subtables::keys)
      : TableReader(node, std::span(keys.begin(), keys.size()), subtables)
  {
  }

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  /// The value of an allowed key, or null. Subtables named by the user do not count.
  [[nodiscard]] const Node* find(std::string_view key) const;
  /// The value of an allowed key that must be there.
  [[nodiscard]] const Node& require(std::string_view key, const std::string& hint) const;
  /// The tables named by the user.
  [[nodiscard]] std::vector<const Entry*> named() const;
  [[nodiscard]] const Where& where() const { return where_; }

  /// target = convert(value) if the key is given.
  template <class T, class Convert>
  void read(std::string_view key, T& target, const Convert& convert) const
  {
    if (const Node* node = find(key)) target = convert(*node);
  }

 private:
  [[nodiscard]] bool is_named(const Entry& entry) const
  {
    return subtables_ == Subtables::named && entry.node.is_table();
  }

  const Node::Table* table_;
  std::vector<std::string> keys_;
  Subtables subtables_;
  const Where& where_;
};

/// Keys that go with one of several choices.
struct KeyGroup
{
  std::string_view name;  ///< of the choice
  std::vector<std::string_view> keys;
};

/// Throws for a key that is none of the chosen group but one of another; `what` is the key of the choice.
void refuse_keys_of_others(const TableReader& table, std::string_view what, std::span<const KeyGroup> groups,
                           std::size_t chosen);

/// A value of the wrong type.
[[noreturn]] void fail_type(const Node& node, std::string_view expected, const std::string& hint);

[[nodiscard]] std::string to_text(const Node& node);
[[nodiscard]] bool to_bool(const Node& node);
/// A finite number; integers count.
[[nodiscard]] double to_number(const Node& node);
/// A number or a formula.
[[nodiscard]] problem::Field to_field(const Node& node);
/// A number or a formula; throws if it is a negative constant.
[[nodiscard]] problem::Field to_nonnegative_field(const Node& node);
/// The items of an array of 2 or 3 (dim); `what` describes it, such as "one component per dimension".
[[nodiscard]] const Node::Array& to_components(const Node& node, std::string_view what);
[[nodiscard]] std::vector<problem::Field> to_fields(const Node& node);
/// One number per dimension; `what` as above.
[[nodiscard]] std::vector<double> to_numbers(const Node& node,
                                             std::string_view what = "one number per dimension");
/// The same of a vector that is not 0.
[[nodiscard]] std::vector<double> to_vector(const Node& node, std::string_view what, const std::string& hint);
/// "normal", for which it is empty, or a vector that is not 0.
[[nodiscard]] std::vector<double> to_direction(const Node& node, const std::string& hint);

/// The numbers a key takes.
struct Interval
{
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool includes_lower = false;
  bool includes_upper = false;
};
inline constexpr Interval positive{.lower = 0.0};
/// Positive numbers whose squares and products are in the range of a double.
inline constexpr Interval reasonable{
    .lower = 1e-60, .upper = 1e60, .includes_lower = true, .includes_upper = true};
inline constexpr Interval not_negative{.lower = 0.0, .includes_lower = true};

/// A number in the interval; the hint is a sentence about what would be right.
[[nodiscard]] double to_number_in(const Node& node, const Interval& interval, const std::string& hint);
/// An integer in [lower, upper].
[[nodiscard]] long to_integer_in(const Node& node, long lower, long upper, const std::string& hint);

/// The converter Node -> double for TableReader::read.
[[nodiscard]] inline auto number_in(Interval interval, const std::string& hint)
{
  return [=](const Node& node) { return to_number_in(node, interval, hint); };
}

/// The converter Node -> Integer for TableReader::read.
template <class Integer = int>
[[nodiscard]] auto integer_from(Integer lower, const std::string& hint,
                                Integer upper = std::numeric_limits<Integer>::max())
{
  return [=](const Node& node) { return static_cast<Integer>(to_integer_in(node, lower, upper, hint)); };
}

/// The position of the string in `names`; throws listing them.
[[nodiscard]] std::size_t to_choice(const Node& node, const std::vector<std::string>& names);

/// The converter Node -> Enum for TableReader::read; the names are those of the values 0, 1, ...
template <class Enum>
[[nodiscard]] auto one_of(std::vector<std::string> names)
{
  return [names = std::move(names)](const Node& node) { return static_cast<Enum>(to_choice(node, names)); };
}

}  // namespace tribound::case_file
