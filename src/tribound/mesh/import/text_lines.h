#pragma once

/// @file text_lines.h
/// A text line by line, with the number of the line for messages.

#include <algorithm>
#include <string>
#include <string_view>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// Without blanks at both ends.
[[nodiscard]] inline std::string_view trimmed(std::string_view text)
{
  constexpr std::string_view blanks = " \t\r\n\v\f";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

class TextLines
{
 public:
  /// A place between two lines.
  struct Place
  {
    std::size_t begin = 0;
    int line = 0;
  };

  TextLines(std::string_view text, const Where& where) : text_(text), where_(where) {}

  /// Whether there was another line, which becomes line().
  [[nodiscard]] bool next()
  {
    if (place_.begin >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', place_.begin), text_.size());
    line_ = text_.substr(place_.begin, end - place_.begin);
    before_ = place_;
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    place_ = {end + 1, place_.line + 1};
    return true;
  }
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] int number() const { return place_.line; }
  /// Before line().
  [[nodiscard]] const Place& before() const { return before_; }
  void go_to(const Place& place) { place_ = place; }

  [[noreturn]] void fail(const std::string& problem, const std::string& hint = {}) const
  {
    Where where = where_;
    where.line = place_.line;
    throw InputError(where, problem, hint);
  }

 private:
  std::string_view text_;
  Where where_;
  Place before_{};
  Place place_{};  ///< behind line()
  std::string_view line_{};
};

}  // namespace tribound::mesh
