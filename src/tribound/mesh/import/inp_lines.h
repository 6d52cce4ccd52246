#pragma once

/// @file inp_lines.h
/// The lines of a deck for Abaqus or CalculiX, across the files that it includes.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/mesh/import/file_text.h"

namespace tribound::mesh
{

/// A line of a deck: one of its files, counted in the order of reading, and a line there, 1-based.
struct InpPlace
{
  int file = 0;
  int line = 0;
};

/// "*ELEMENT, TYPE=C3D8, ELSET=body". Names of keywords and parameters are in capitals.
struct InpKeyword
{
  std::string name;  ///< "ELEMENT"
  std::vector<std::pair<std::string, std::string>> parameters{};
  InpPlace place{};

  /// The value of a parameter, empty where it is a flag; nothing if it is not given.
  [[nodiscard]] std::optional<std::string> find(std::string_view parameter) const;
};

class InpLines
{
 public:
  explicit InpLines(const std::filesystem::path& file);

  /// Goes on to the next line that is neither empty nor a comment; false at the end of the deck.
  [[nodiscard]] bool next();
  /// "*..." with its continuation lines if is_keyword(), else data; without blanks at both ends.
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] bool is_keyword() const { return !text_.empty() && text_.front() == '*'; }
  [[nodiscard]] InpKeyword keyword() const;
  /// The comma-separated fields of a data line, without blanks; an empty one at the end does not count. Valid
  /// until the next call.
  [[nodiscard]] std::span<const std::string_view> fields();

  /// Continues with the lines of another file, named relative to the present one, then goes on here. Throws
  /// InputError where a file includes itself.
  void include(const std::string& name);

  [[nodiscard]] InpPlace place() const { return place_; }
  /// All files so far.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
  [[nodiscard]] Where where(const InpPlace& place) const;
  /// The value of a parameter. Throws InputError if it is not given or empty.
  [[nodiscard]] std::string required(const InpKeyword& keyword, std::string_view parameter) const;
  /// A finite number. Throws InputError.
  [[nodiscard]] double number(std::string_view field, const InpPlace& place) const;
  [[noreturn]] void fail(const InpPlace& place, const std::string& problem,
                         const std::string& hint = {}) const
  {
    throw InputError(where(place), problem, hint);
  }

 private:
  struct Source
  {
    int file;
    std::string content;
    std::size_t position = 0;
    int line = 0;
  };

  void open(const std::filesystem::path& file);
  /// The next line of any kind; false at the end of the innermost file.
  bool read_line();

  std::vector<Source> open_{};                  ///< the innermost last
  std::vector<std::filesystem::path> files_{};  ///< all so far
  std::string_view text_{};
  std::string joined_{};  ///< a keyword line with its continuations
  InpPlace place_{};
  std::vector<std::string_view> fields_{};
};

/// In capitals (ASCII); names in decks do not distinguish cases.
[[nodiscard]] std::string capitals(std::string_view text);
/// Without blanks and quotes around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace tribound::mesh
