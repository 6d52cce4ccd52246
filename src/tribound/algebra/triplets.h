#pragma once

/// @file triplets.h
/// Sparse matrices as plain data.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tribound::algebra
{

/// Sparse matrix entries (row, column, value), to be added up; entries with row or column -1 do not count.
struct Triplets
{
  std::vector<int> rows;
  std::vector<int> cols;
  std::vector<double> values;

  void reserve(std::size_t n)
  {
    rows.reserve(n);
    cols.reserve(n);
    values.reserve(n);
  }
  void add(int row, int col, double value)
  {
    rows.push_back(row);
    cols.push_back(col);
    values.push_back(value);
  }
  void resize(std::size_t n)
  {
    rows.resize(n);
    cols.resize(n);
    values.resize(n);
  }
  void put(std::size_t position, int row, int col, double value)
  {
    rows[position] = row;
    cols[position] = col;
    values[position] = value;
  }
};

/// A square sparse matrix row by row; the columns of a row are ascending, each once.
struct SparseRows
{
  std::vector<int> begin{0};  ///< row i has the entries begin[i], ..., begin[i + 1] - 1
  std::vector<int> columns;
  std::vector<double> values;

  /// Adds an entry to the last row.
  void add(int column, double value)
  {
    columns.push_back(column);
    values.push_back(value);
  }
  void end_row() { begin.push_back(static_cast<int>(columns.size())); }
  /// Appends the rows of another matrix.
  void append(const SparseRows& more)
  {
    const int shift = begin.back();
    for (std::size_t i = 1; i < more.begin.size(); ++i) begin.push_back(shift + more.begin[i]);
    columns.insert(columns.end(), more.columns.begin(), more.columns.end());
    values.insert(values.end(), more.values.begin(), more.values.end());
  }
  /// Entry (row, column), which the row must have.
  [[nodiscard]] double entry(int row, int column) const
  {
    const auto first = columns.begin() + begin[row];
    const auto found = std::lower_bound(first, columns.begin() + begin[row + 1], column);
    return values[found - columns.begin()];
  }
};

}  // namespace tribound::algebra
