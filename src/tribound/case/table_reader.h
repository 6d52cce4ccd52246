#pragma once

/// @file table_reader.h
/// Typed, checked access to the tables of a case file. Every function throws InputError that gives the
/// position of the value, what is wrong with it and what would be right.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "tribound/case/keys.h"
#include "tribound/case/node.h"
#include "tribound/problem/field.h"

namespace tribound::case_file
{

/// A table of a case, and the keys it may have.
class TableReader
{
 public:
  /// Checks that `node` is a table and that its keys are among those of `table`, or are tables named by the
  /// user where these are allowed. Keeps references to both.
  TableReader(const Node& node, const Table& table);

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  /// The value of an allowed key, or null. Tables named by the user do not count.
  [[nodiscard]] const Node* find(std::string_view key) const;
  /// The value of a required, allowed key; the hint is that of the key, or the given one.
  [[nodiscard]] const Node& require(std::string_view key) const { return require(key, key_of(key).missing); }
  [[nodiscard]] const Node& require(std::string_view key, const std::string& hint) const;
  /// The tables named by the user.
  [[nodiscard]] std::vector<const Entry*> named() const;
  [[nodiscard]] const Where& where() const { return where_; }
  [[nodiscard]] const Key& key_of(std::string_view key) const;

  /// The given key of `one_of`; empty: none. Throws where another one is also given; the message calls it
  /// `beside`, or by its name.
  [[nodiscard]] std::string only(const std::string& hint, std::string_view beside = {}) const;
  /// The given key that `key` excludes; null: none.
  [[nodiscard]] const Node* excluded_by(std::string_view key) const;
  /// The index of the group chosen by the word of `choice`. Throws for keys of other groups.
  [[nodiscard]] std::size_t choose() const;
  /// Throws where a key required by the group is missing.
  void require_group(std::size_t chosen) const;

  /// Sets target to the value of the key, if it is given.
  template <class T>
  void read(std::string_view key, T& target) const
  {
    if (const Node* node = find(key)) convert(*node, key_of(key).value, target);
  }
  /// The value of a required key.
  template <class T>
  [[nodiscard]] T get(std::string_view key) const
  {
    T target{};
    convert(require(key), key_of(key).value, target);
    return target;
  }

 private:
  [[nodiscard]] bool is_named(const Entry& entry) const { return shape_.named && entry.node.is_table(); }

  const Node::Table* entries_;
  const Table& shape_;
  const Where& where_;
};

/// Throws for a value of the wrong type.
[[noreturn]] void fail_type(const Node& node, std::string_view expected, const std::string& hint);

[[nodiscard]] std::string to_text(const Node& node);
/// A finite number; integers are accepted.
[[nodiscard]] double to_number(const Node& node);
/// A number or a formula.
[[nodiscard]] problem::Field to_field(const Node& node);
/// An integer in [lower, upper].
[[nodiscard]] long to_integer_in(const Node& node, long lower, long upper, const std::string& hint);
/// A number in the interval.
[[nodiscard]] double to_number_in(const Node& node, const Interval& interval, const std::string& hint);
/// The position of the string in `names`; otherwise throws, listing them.
[[nodiscard]] std::size_t to_choice(const Node& node, const std::vector<std::string>& names);
/// The entries of an array, or a single value where that is allowed in its place.
[[nodiscard]] std::span<const Node> to_items(const Node& node, const Value& value);

/// Whether the node is one of the words for "not given", such as "free". Throws for another word where no
/// other text is allowed.
[[nodiscard]] bool is_word(const Node& node, const Value& value);

/// Sets target to the value of the node, checked against what is allowed.
void convert(const Node& node, const Value& value, bool& target);
void convert(const Node& node, const Value& value, double& target);
void convert(const Node& node, const Value& value, std::string& target);
void convert(const Node& node, const Value& value, std::filesystem::path& target);
void convert(const Node& node, const Value& value, problem::Field& target);

template <class T>
requires std::is_integral_v<T>
void convert(const Node& node, const Value& value, T& target)
{
  const double upper = value.number->upper;
  const long largest = std::numeric_limits<T>::max();
  target = static_cast<T>(
      to_integer_in(node, static_cast<long>(value.number->lower),
                    upper < static_cast<double>(largest) ? static_cast<long>(upper) : largest, value.hint));
}

/// The words correspond to the values 0, 1, ...
template <class T>
requires std::is_enum_v<T>
void convert(const Node& node, const Value& value, T& target)
{
  target = static_cast<T>(to_choice(node, value.words));
}

/// A word means "not given".
template <class T>
void convert(const Node& node, const Value& value, std::optional<T>& target)
{
  if (is_word(node, value))
    target.reset();
  else
    convert(node, value, target.emplace());
}

/// Likewise.
template <class T>
void convert(const Node& node, const Value& value, std::vector<T>& target)
{
  target.clear();
  if (is_word(node, value)) return;
  for (const Node& item : to_items(node, value)) convert(item, value.items.front(), target.emplace_back());
  if constexpr (std::is_same_v<T, double>)
    if (value.has_length && std::ranges::count(target, 0.0) == std::ssize(target))
      throw InputError(node.where, "has no length", value.hint);
}

/// A key that sets a member of a T.
template <class T>
struct Option
{
  Key key;
  void (*read)(const TableReader& table, std::string_view key, T& target);
};

namespace detail
{
template <class T, class Member>
T owner(Member T::*);
}  // namespace detail

/// The key that sets target.*member, or (target.*member).*inner ...
template <auto member, auto... inner>
[[nodiscard]] auto option(std::string name, Value value, std::string missing = {})
{
  using T = decltype(detail::owner(member));
  return Option<T>{{std::move(name), std::move(value), std::move(missing)},
                   [](const TableReader& table, std::string_view key, T& target)
                   { table.read(key, ((target.*member).*....*inner)); }};
}

/// A table whose keys each set a member of a T.
template <class T>
class Options
{
 public:
  Options(std::string name, const std::vector<Option<T>>& options, Refusal refused = {})
      : table_{.name = std::move(name), .refused = std::move(refused)}
  {
    for (const Option<T>& option : options)
    {
      table_.keys.push_back(option.key);
      readers_.push_back(option.read);
    }
  }

  [[nodiscard]] const Table& table() const { return table_; }
  /// Sets the given members.
  void read(const TableReader& given, T& target) const
  {
    for (std::size_t i = 0; i < readers_.size(); ++i)
    {
      const Key& key = table_.keys[i];
      if (!key.missing.empty()) (void)given.require(key.name);
      readers_[i](given, key.name, target);
    }
  }
  void read(const Node& node, T& target) const { read(TableReader(node, table_), target); }

 private:
  Table table_;
  std::vector<void (*)(const TableReader&, std::string_view, T&)> readers_;
};

}  // namespace tribound::case_file
