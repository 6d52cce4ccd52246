#pragma once

/// @file block_cholesky.h
/// Cholesky factorisation of a small block-sparse symmetric positive definite matrix with dense blocks of one
/// size: the multipliers of a patch, whose graph is a path or cycle in 2D and the edges of a triangulated
/// sphere in 3D.

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/small_dense.h"

namespace tribound::certify
{

/// Usage: reset, connect, order; then the blocks have the names that order() gave them: add to them, factor,
/// solve. Storage is kept from one matrix to the next, so that a loop over patches allocates nothing once it
/// has met the largest of them.
template <int n>
class BlockCholesky
{
 public:
  using Matrix = Dense<n, n>;
  using Vector = DenseVector<n>;

  void reset(int n_blocks)
  {
    n_ = n_blocks;
    words_ = (n_ + 63) / 64;
    adjacency_.assign(static_cast<std::size_t>(n_) * words_, 0);
  }

  /// There will be a block (i, j).
  void connect(int i, int j)
  {
    adjacency_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64);
    adjacency_[j * words_ + i / 64] |= std::uint64_t{1} << (i % 64);
  }

  /// Orders by minimum fill or degree and makes room for all blocks, which become 0. Returns the position
  /// of each block in that order: its new number.
  std::span<const int> order()
  {
    sequence_.clear();
    rank_.assign(n_, -1);
    for (int step = 0; step < n_; ++step) eliminate_symbolically(next(), step);
    collect_rows();
    return rank_;
  }

  /// What order() returned.
  [[nodiscard]] std::span<const int> rank() const { return rank_; }

  /// Gives up the room that other matrices needed.
  void trim()
  {
    pool_.resize(columns_.size());
    pool_.shrink_to_fit();
  }
  /// The memory of the blocks.
  [[nodiscard]] std::size_t bytes() const { return columns_.size() * sizeof(Matrix); }

  /// Block (i, j), i <= j, of the upper triangle; i and j are connected.
  [[nodiscard]] Matrix& block(int i, int j)
  {
    assert(i <= j);
    return pool_[index_[i * n_ + j]];
  }

  /// All blocks become 0 again; order and connections stay.
  void clear() { std::fill_n(pool_.begin(), columns_.size(), Matrix{}); }

  /// Replaces `count` rows and columns of block row i, from `begin` on, by those of a multiple of the
  /// identity.
  template <int count>
  void decouple(int i, int begin)
  {
    Matrix& diagonal = block(i, i);
    double scale = 0;
    for (int k = 0; k < n; ++k) scale += diagonal(k, k) / n;
    for (int e = 0; e < row_begin_[i + 1]; ++e)
    {
      if (e >= row_begin_[i])
        for (int k = begin; k < begin + count; ++k) std::fill_n(pool_[e].row(k), n, 0.0);
      if (columns_[e] == i)
        for (int k = 0; k < n; ++k) std::fill_n(pool_[e].row(k) + begin, count, 0.0);
    }
    for (int k = begin; k < begin + count; ++k) diagonal(k, k) = scale;
  }

  /// y -= A x, of the matrix as it is before factor().
  void subtract_product(std::span<const Vector> x, std::span<Vector> y) const
  {
    for (int i = 0; i < n_; ++i)
      for (int e = row_begin_[i]; e < row_begin_[i + 1]; ++e)
      {
        const int j = columns_[e];
        subtract_times<n, stride>(y[i].data(), pool_[e].data(), stride, x[j].data());
        if (j > i) subtract_transposed_times<n, stride>(y[j].data(), pool_[e].data(), stride, x[i].data());
      }
  }

  /// A = U^T U. Returns false if a pivot is not positive definite.
  [[nodiscard]] bool factor()
  {
    for (int i = 0; i < n_; ++i)
    {
      const int begin = row_begin_[i] + 1;
      const int end = row_begin_[i + 1];
      const Matrix& pivot = pool_[begin - 1];
      if (!cholesky<n>(pool_[begin - 1].data(), stride, reciprocal_[i].data())) return false;
      for (int e = begin; e < end; ++e)
        solve_transposed<n, stride>(pivot.data(), stride, reciprocal_[i].data(), pool_[e].data(), stride);
      for (int e = begin; e < end; ++e)
      {
        subtract_gram<n, n>(block(columns_[e], columns_[e]).data(), pool_[e].data(), stride);
        for (int f = e + 1; f < end; ++f)
          subtract_transposed_product<n, stride, n>(block(columns_[e], columns_[f]).data(), stride,
                                                    pool_[e].data(), stride, pool_[f].data(), stride);
      }
    }
    return true;
  }

  /// Solves in place.
  void solve(std::span<Vector> x) const
  {
    for (int i = 0; i < n_; ++i)
    {
      const int diagonal = row_begin_[i];
      solve_transposed<n>(pool_[diagonal].data(), stride, reciprocal_[i].data(), x[i].data());
      for (int e = diagonal + 1; e < row_begin_[i + 1]; ++e)
        subtract_transposed_times<n, stride>(x[columns_[e]].data(), pool_[e].data(), stride, x[i].data());
    }
    for (int i = n_ - 1; i >= 0; --i)
    {
      const int diagonal = row_begin_[i];
      for (int e = diagonal + 1; e < row_begin_[i + 1]; ++e)
        subtract_times<n, stride>(x[i].data(), pool_[e].data(), stride, x[columns_[e]].data());
      solve_upper<n>(pool_[diagonal].data(), stride, reciprocal_[i].data(), x[i].data());
    }
  }
  /// The same for m right-hand sides, the columns.
  template <int m>
  void solve(std::span<Dense<n, m>> x) const
  {
    constexpr int width = padded(m);
    for (int i = 0; i < n_; ++i)
    {
      const int diagonal = row_begin_[i];
      solve_transposed<n, width>(pool_[diagonal].data(), stride, reciprocal_[i].data(), x[i].data(), width);
      for (int e = diagonal + 1; e < row_begin_[i + 1]; ++e)
        subtract_transposed_product<n, width, n>(x[columns_[e]].data(), width, pool_[e].data(), stride,
                                                 x[i].data(), width);
    }
    for (int i = n_ - 1; i >= 0; --i)
    {
      const int diagonal = row_begin_[i];
      for (int e = diagonal + 1; e < row_begin_[i + 1]; ++e)
        certify::subtract_product<n, width, n>(x[i].data(), width, pool_[e].data(), stride,
                                               x[columns_[e]].data(), width);
      solve_upper<n, width>(pool_[diagonal].data(), stride, reciprocal_[i].data(), x[i].data(), width);
    }
  }

 private:
  static constexpr int stride = Matrix::stride;

  /// What comes first in the order of elimination, the smallest number next. Large blocks: the pairs of
  /// neighbours that elimination joins, twice, of equals those with most neighbours, as these need not come
  /// later. It saves a tenth of the operations, but not the time that it takes where blocks are small.
  [[nodiscard]] int cost_of_elimination(int i) const
  {
    int degree = 0;
    for (int w = 0; w < words_; ++w) degree += std::popcount(adjacency_[i * words_ + w]);
    if constexpr (n < 12) return degree;
    int joined = -degree;  // a neighbour is not its own
    for_later_neighbours(i,
                         [&](int j)
                         {
                           for (int w = 0; w < words_; ++w)
                             joined +=
                                 std::popcount(adjacency_[i * words_ + w] & ~adjacency_[j * words_ + w]);
                         });
    return joined * (n_ + 1) - degree;
  }

  [[nodiscard]] int next() const
  {
    int best = -1;
    int least = std::numeric_limits<int>::max();
    for (int i = 0; i < n_; ++i)
    {
      if (rank_[i] >= 0) continue;
      const int cost = cost_of_elimination(i);
      if (cost >= least) continue;
      best = i;
      least = cost;
    }
    return best;
  }

  /// Calls `visit` for the neighbours of k that are not yet eliminated when k is.
  template <class Visit>
  void for_later_neighbours(int k, Visit visit) const
  {
    for (int w = 0; w < words_; ++w)
      for (std::uint64_t word = adjacency_[k * words_ + w]; word != 0; word &= word - 1)
        visit(64 * w + std::countr_zero(word));
  }

  /// Joins the neighbours of k to each other and takes k out of their rows.
  void eliminate_symbolically(int k, int step)
  {
    assert(k >= 0);
    for_later_neighbours(k,
                         [&](int i)
                         {
                           for (int w = 0; w < words_; ++w)
                             adjacency_[i * words_ + w] |= adjacency_[k * words_ + w];
                           adjacency_[i * words_ + i / 64] &= ~(std::uint64_t{1} << (i % 64));
                           adjacency_[i * words_ + k / 64] &= ~(std::uint64_t{1} << (k % 64));
                         });
    rank_[k] = step;
    sequence_.push_back(k);
  }

  /// Row i: the diagonal, then the later neighbours in ascending order.
  void collect_rows()
  {
    columns_.clear();
    row_begin_.assign(1, 0);
    index_.resize(std::max(index_.size(), static_cast<std::size_t>(n_) * n_));
    reciprocal_.resize(std::max(reciprocal_.size(), static_cast<std::size_t>(n_)));
    for (int i = 0; i < n_; ++i)
    {
      columns_.push_back(i);
      for_later_neighbours(sequence_[i], [&](int k) { columns_.push_back(rank_[k]); });
      std::sort(columns_.begin() + row_begin_.back(), columns_.end());
      for (int e = row_begin_.back(); e < static_cast<int>(columns_.size()); ++e)
        index_[i * n_ + columns_[e]] = e;
      row_begin_.push_back(static_cast<int>(columns_.size()));
    }
    pool_.resize(std::max(pool_.size(), columns_.size()));
    clear();
  }

  int n_ = 0;
  int words_ = 0;
  std::vector<std::uint64_t> adjacency_;  ///< bit rows
  std::vector<int> sequence_;             ///< blocks in order of elimination
  std::vector<int> rank_;                 ///< its inverse; -1 for those to come

  std::vector<int> row_begin_;  ///< of the rows in columns_ and pool_
  std::vector<int> columns_;
  std::vector<int> index_;                         ///< position of block (i, j) in columns_ and pool_
  std::vector<Matrix> pool_;                       ///< A, then U
  std::vector<std::array<double, n>> reciprocal_;  ///< of the diagonal of U
};

}  // namespace tribound::certify
