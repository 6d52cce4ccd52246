#pragma once

/// @file frd_records.h
/// The records of CalculiX's results as text.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tribound/mesh/import/text_lines.h"

namespace tribound::mesh
{

inline constexpr const char* damaged_frd = "the file is damaged or cut off: write it again with CalculiX";

/// Lines with fields of fixed width, which may touch: " -1", the number of a node, numbers of 12 characters.
/// All members throw InputError with the line.
class FrdRecords
{
 public:
  static constexpr std::size_t n_key = 3;  ///< " -1"

  explicit FrdRecords(const std::filesystem::path& file);
  FrdRecords(const FrdRecords&) = delete;
  FrdRecords& operator=(const FrdRecords&) = delete;

  [[nodiscard]] const Where& where() const { return where_; }
  [[nodiscard]] bool next() { return lines_.next(); }
  /// Goes on to the next record, which must exist.
  void next_in(std::string_view block);
  [[nodiscard]] const TextLines::Place& before() const { return lines_.before(); }
  void go_to(const TextLines::Place& place) { lines_.go_to(place); }

  /// Without blanks; empty behind the end of the line.
  [[nodiscard]] std::string_view field(std::size_t begin, std::size_t width) const;
  [[nodiscard]] std::string_view key() const { return field(0, n_key); }
  [[nodiscard]] std::int64_t integer(std::size_t begin, std::size_t width, std::string_view what) const;
  [[nodiscard]] double number(std::size_t begin, std::string_view what) const;
  /// Of nodes and elements in the records after this one, which ends with its format.
  [[nodiscard]] std::size_t width_of_numbers() const;

  [[noreturn]] void fail(const std::string& problem, const std::string& hint = damaged_frd) const
  {
    lines_.fail(problem, hint);
  }

 private:
  Where where_;
  std::string content_;
  TextLines lines_;
};

}  // namespace tribound::mesh
