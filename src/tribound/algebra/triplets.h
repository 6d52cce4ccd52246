#pragma once

/// @file triplets.h
/// Sparse matrices as lists of entries.

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
};

}  // namespace tribound::algebra
