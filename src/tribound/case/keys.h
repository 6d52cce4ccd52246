#pragma once

/// @file keys.h
/// The keys of a case file as data: which values each accepts, and which go together. The readers check their
/// input against them, and `tribound schema` prints them.

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribound::case_file
{

/// Numbers between two ends, each of which may be included.
struct Interval
{
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool includes_lower = false;
  bool includes_upper = false;
};
inline constexpr Interval finite{};
inline constexpr Interval positive{.lower = 0.0};
inline constexpr Interval not_negative{.lower = 0.0, .includes_lower = true};
/// Positive numbers whose squares and products are in the range of a double.
inline constexpr Interval reasonable{
    .lower = 1e-60, .upper = 1e60, .includes_lower = true, .includes_upper = true};

struct Table;

/// The values a key accepts: any of the forms that are set.
struct Value
{
  bool truth = false;                ///< true or false
  bool text = false;                 ///< any string: a name, a file, a formula
  bool is_formula = false;           ///< the string
  std::vector<std::string> words{};  ///< strings with a meaning of their own
  std::optional<Interval> number{};
  bool is_integer = false;     ///< the number
  bool is_literal = false;     ///< the number; no formula of parameters
  std::vector<Value> items{};  ///< of an array: what each entry accepts; empty: no array
  const Table* table = nullptr;
  std::size_t least = 0;  ///< characters or entries
  std::size_t most = std::numeric_limits<std::size_t>::max();
  bool has_length = false;  ///< whether an array of zeros is refused
  std::string hint{};       ///< what would be right, for messages
};

/// A key of a table.
struct Key
{
  std::string name;
  Value value;
  std::string missing{};  ///< what would be right where the key is missing; empty: it is optional
};

/// Keys that go with one of several words.
struct KeyGroup
{
  std::string_view word;
  std::vector<std::string> keys{};
  std::vector<std::string> required{};
};

/// Requirements of a key on other keys.
struct Relation
{
  std::string key;
  std::vector<std::string> needs{};
  std::vector<std::string> excludes{};
};

/// Keys of other programs that have a reason for not being here.
struct Refusal
{
  std::vector<std::string> keys{};
  std::string problem{};
  std::string hint{};
};

/// The keys of a table.
struct Table
{
  std::string name;  ///< as in docs/case-format.md, with NAME for names chosen by the user; empty: the case
  std::vector<Key> keys{};
  std::optional<Value> named{};       ///< what keys named by the user accept; then none is missing
  std::vector<std::string> one_of{};  ///< exactly one of these is given; empty: any
  std::vector<Relation> relations{};
  std::string choice{};            ///< the key whose word chooses a group; empty: none
  std::vector<KeyGroup> groups{};  ///< the first one applies where the key is optional
  Refusal refused{};
};

/// Make values; `hint` is a sentence about what would be right.
[[nodiscard]] Value truth();
[[nodiscard]] Value text(std::string hint = {}, std::size_t least = 0);
[[nodiscard]] Value one_of(std::vector<std::string> words);
[[nodiscard]] Value number_in(Interval interval, std::string hint = {});
[[nodiscard]] Value integer_from(double lower, std::string hint,
                                 double upper = std::numeric_limits<double>::infinity());
[[nodiscard]] Value formula();
/// A number or a formula.
[[nodiscard]] Value datum();
[[nodiscard]] Value nonnegative_datum(std::string hint = {});
/// An array of 2 or 3 items.
[[nodiscard]] Value vector_of(Value item, std::string hint);
[[nodiscard]] Value numbers(std::string hint = "one number per dimension");
[[nodiscard]] Value data(std::string hint = "one number or formula per dimension, such as [0, -1]");
/// Numbers that are not all 0.
[[nodiscard]] Value direction(std::string hint);
/// An array of at least `least` items.
[[nodiscard]] Value array_of(Value item, std::size_t least, std::string hint);
/// A table with these keys. Keeps a reference.
[[nodiscard]] Value keys_of(const Table& table);
/// Either value; limits and hint are those of the first, if it has any.
[[nodiscard]] Value operator|(Value one, const Value& other);

/// Concatenates the lists.
[[nodiscard]] std::vector<Key> operator+(std::vector<Key> keys, const std::vector<Key>& others);

/// Forces in points, under which the displacement is infinite: 1/r in 3D, log r in 2D.
[[nodiscard]] Refusal point_loads();

/// Every key and table of a case file.
[[nodiscard]] const Table& case_table();

}  // namespace tribound::case_file
