#include "tribound/algebra/sparse_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "tribound/base/error.h"

namespace tribound::algebra
{

void require_countable(std::size_t n_entries)
{
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (n_entries > most)
    throw SolveError(fmt::format(
        "the matrix of a process has {} entries, at most {} can be counted with 32 bits: take more "
        "processes or fewer unknowns",
        n_entries, most));
}

// Contact has many entries for one place: a marker per column finds them faster than a sort.
SparseRows pattern_of(Index n, const Triplets& entries, std::vector<int>& places)
{
  require_countable(entries.rows.size());
  const auto counts = [&](std::size_t k) { return entries.rows[k] >= 0 && entries.cols[k] >= 0; };
  places.assign(entries.rows.size(), -1);
  std::vector<int> begin(n + 1, 0);
  for (std::size_t k = 0; k < places.size(); ++k)
    if (counts(k)) ++begin[entries.rows[k] + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> by_row(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t k = 0; k < places.size(); ++k)
    if (counts(k)) by_row[next[entries.rows[k]]++] = static_cast<int>(k);

  SparseRows rows;
  std::vector<int> place(n, -1);  // of a column in this row; less than `first`: not yet in the row
  for (Index i = 0; i < n; ++i)
  {
    const std::span<const int> in_row(by_row.data() + begin[i], by_row.data() + begin[i + 1]);
    const int first = rows.begin.back();
    for (const int k : in_row)
      if (std::exchange(place[entries.cols[k]], first) < first) rows.columns.push_back(entries.cols[k]);
    rows.end_row();
    std::sort(rows.columns.begin() + first, rows.columns.end());
    for (int k = first; k < rows.begin.back(); ++k) place[rows.columns[k]] = k;
    for (const int k : in_row) places[k] = place[entries.cols[k]];
  }
  rows.values.assign(rows.columns.size(), 0.0);
  return rows;
}

namespace
{

/// Adds row i of `a` to that of `sum`, which contains its columns.
void add_row(const SparseRows& a, std::size_t i, SparseRows& sum)
{
  int place = sum.begin[i];
  for (int k = a.begin[i]; k < a.begin[i + 1]; ++k)
  {
    while (sum.columns[place] != a.columns[k]) ++place;
    assert(place < sum.begin[i + 1]);
    sum.values[place++] += a.values[k];
  }
}

/// Row i of `sum` becomes that of a + b.
void assign_row(const SparseRows& a, const SparseRows& b, std::size_t i, SparseRows& sum)
{
  const auto begin = sum.values.begin() + sum.begin[i];
  const auto end = sum.values.begin() + sum.begin[i + 1];
  if (a.begin[i + 1] - a.begin[i] == end - begin)
    std::copy(a.values.begin() + a.begin[i], a.values.begin() + a.begin[i + 1], begin);
  else
  {
    std::fill(begin, end, 0.0);
    add_row(a, i, sum);
  }
  add_row(b, i, sum);
}

}  // namespace

SparseRows sum(const SparseRows& a, const SparseRows& b)
{
  assert(a.begin.size() == b.begin.size());
  SparseRows result;
  result.columns.reserve(a.columns.size() + b.columns.size());
  for (std::size_t i = 0; i + 1 < a.begin.size(); ++i)
  {
    std::set_union(a.columns.begin() + a.begin[i], a.columns.begin() + a.begin[i + 1],
                   b.columns.begin() + b.begin[i], b.columns.begin() + b.begin[i + 1],
                   std::back_inserter(result.columns));
    result.end_row();
  }
  require_countable(result.columns.size());
  result.columns.shrink_to_fit();
  result.values.resize(result.columns.size());
  for (std::size_t i = 0; i + 1 < a.begin.size(); ++i) assign_row(a, b, i, result);
  return result;
}

void assign_sum(const SparseRows& a, const SparseRows& b, SparseRows& result)
{
  for (std::size_t i = 0; i + 1 < result.begin.size(); ++i)
    if (b.begin[i] < b.begin[i + 1]) assign_row(a, b, i, result);
}

}  // namespace tribound::algebra
