#pragma once

/// @file csv.h
/// Tables, and their text: rows of comma-separated values (RFC 4180).

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tribound::io
{

/// A text as written in a cell.
[[nodiscard]] std::string csv_cell(std::string_view value);

/// Builds a table row by row. Numbers are printed with the fewest digits that read back as the same number.
class CsvTable
{
 public:
  /// Starts with the line of column names, which are separated by commas.
  explicit CsvTable(std::string_view columns) : text_(columns) { end_row(); }

  void add(std::string_view value)
  {
    separate();
    text_ += csv_cell(value);
  }
  /// -0 is written as 0: the sign of zero is no result.
  void add(double value);
  void add(long value);
  void add(int value) { add(static_cast<long>(value)); }
  /// An unknown number leaves its cell empty.
  void add(std::optional<double> value) { value ? add(*value) : add(std::string_view{}); }

  void end_row()
  {
    text_ += '\n';
    row_is_empty_ = true;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void separate()
  {
    if (!row_is_empty_) text_ += ',';
    row_is_empty_ = false;
  }

  std::string text_;
  bool row_is_empty_ = true;
};

/// A cell with the name of its column: a whole number, a number that may be unknown, or a text.
struct TableCell
{
  std::string name;
  std::variant<long, std::optional<double>, std::string> value;
};

using TableRow = std::vector<TableCell>;

/// The rows below their column names, which are those of `any`, so that a table without rows has them, too.
[[nodiscard]] std::string csv_text(const TableRow& any, std::span<const TableRow> rows);

}  // namespace tribound::io
