#pragma once

/// @file block_cholesky.h
/// Cholesky factorisation of a small block-sparse symmetric positive definite matrix with dense blocks of one
/// size: the multipliers of a patch, whose graph is a path or cycle in 2D and the edges of a triangulated
/// sphere in 3D.

#include <Eigen/Cholesky>
#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

#include "base/types.h"

namespace tribound
{

/// Usage: reset, add blocks, order, (add to the diagonal of the last pivot), factor, solve. Storage is kept
/// from one matrix to the next, so that a loop over patches allocates nothing once it has met the largest of
/// them.
template <int n>
class BlockCholesky
{
 public:
  using Matrix = Eigen::Matrix<double, n, n, Eigen::RowMajor>;
  using Columns = Eigen::Matrix<double, n, 2>;  ///< two right-hand sides

  void reset(int n_blocks)
  {
    n_ = n_blocks;
    words_ = (n_ + 63) / 64;
    place_.assign(static_cast<std::size_t>(n_) * n_, -1);
    used_ = 0;
    for (int i = 0; i < n_; ++i) block(i, i);
  }

  /// Block (i, j) with i <= j of the upper triangle, zero when first asked for.
  Matrix& block(int i, int j)
  {
    assert(i <= j);
    int& place = place_[i * n_ + j];
    if (place < 0)
    {
      if (used_ == static_cast<int>(pool_.size())) pool_.emplace_back();
      place = used_++;
      pool_[place].setZero();
    }
    return pool_[place];
  }

  /// Replaces `count` rows and columns of block row i, from `begin` on, by those of a multiple of the
  /// identity.
  template <int count>
  void decouple(int i, int begin)
  {
    for (int j = 0; j < n_; ++j)
    {
      if (i < j && place_[i * n_ + j] >= 0) block(i, j).template middleRows<count>(begin).setZero();
      if (j < i && place_[j * n_ + i] >= 0) block(j, i).template middleCols<count>(begin).setZero();
    }
    Matrix& diagonal = block(i, i);
    const double scale = diagonal.trace() / n;
    diagonal.template middleRows<count>(begin).setZero();
    diagonal.template middleCols<count>(begin).setZero();
    for (int k = begin; k < begin + count; ++k) diagonal(k, k) = scale;
  }

  /// Chooses the order of elimination by minimum degree. Returns the block that comes last.
  int order()
  {
    adjacency_.assign(static_cast<std::size_t>(n_) * words_, 0);
    for (int i = 0; i < n_; ++i)
      for (int j = i + 1; j < n_; ++j)
        if (place_[i * n_ + j] >= 0) connect(i, j);
    sequence_.clear();
    eliminated_.assign(n_, 0);
    for (int step = 0; step < n_; ++step) eliminate_symbolically(least_connected());
    return sequence_.back();
  }

  /// A = U^T U blockwise. Returns false if a pivot is not positive definite.
  [[nodiscard]] bool factor()
  {
    rank_.assign(n_, 0);
    for (int s = 0; s < n_; ++s) rank_[sequence_[s]] = s;
    pivots_.resize(std::max<std::size_t>(pivots_.size(), n_));
    rows_.clear();
    row_begin_.assign(1, 0);
    n_row_blocks_ = 0;
    for (const int k : sequence_)
    {
      pivots_[k].compute(block(k, k));
      if (pivots_[k].info() != Eigen::Success) return false;
      eliminate(k);
    }
    return true;
  }

  /// Solves in place for two right-hand sides per block.
  void solve(std::vector<Columns>& x) const
  {
    for (int s = 0; s < n_; ++s)
    {
      const int k = sequence_[s];
      pivots_[k].matrixL().solveInPlace(x[k]);
      for (int e = row_begin_[s]; e < row_begin_[s + 1]; ++e)
        x[rows_[e]].noalias() -= row_blocks_[e].transpose() * x[k];
    }
    for (int s = n_ - 1; s >= 0; --s)
    {
      const int k = sequence_[s];
      for (int e = row_begin_[s]; e < row_begin_[s + 1]; ++e) x[k].noalias() -= row_blocks_[e] * x[rows_[e]];
      pivots_[k].matrixU().solveInPlace(x[k]);
    }
  }

 private:
  void connect(int i, int j)
  {
    adjacency_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64);
    adjacency_[j * words_ + i / 64] |= std::uint64_t{1} << (i % 64);
  }

  [[nodiscard]] int least_connected() const
  {
    int best = -1;
    int best_degree = n_ + 1;
    for (int i = 0; i < n_; ++i)
    {
      if (eliminated_[i]) continue;
      int degree = 0;
      for (int w = 0; w < words_; ++w) degree += std::popcount(adjacency_[i * words_ + w]);
      if (degree >= best_degree) continue;
      best = i;
      best_degree = degree;
    }
    return best;
  }

  /// Joins the neighbours of k to each other and takes k out of the graph.
  void eliminate_symbolically(int k)
  {
    for (int i = 0; i < n_; ++i)
    {
      if (!(adjacency_[k * words_ + i / 64] >> (i % 64) & 1)) continue;
      for (int w = 0; w < words_; ++w) adjacency_[i * words_ + w] |= adjacency_[k * words_ + w];
      adjacency_[i * words_ + i / 64] &= ~(std::uint64_t{1} << (i % 64));
      adjacency_[i * words_ + k / 64] &= ~(std::uint64_t{1} << (k % 64));
    }
    eliminated_[k] = 1;
    sequence_.push_back(k);
  }

  /// U(k, i) = L^{-1} A(k, i) for the later neighbours i of k, and A(i, j) -= U(k, i)^T U(k, j).
  void eliminate(int k)
  {
    const int begin = row_begin_.back();
    for (int i = 0; i < n_; ++i)
    {
      if (rank_[i] <= rank_[k]) continue;
      const int place = k < i ? place_[k * n_ + i] : place_[i * n_ + k];
      if (place < 0) continue;
      if (n_row_blocks_ == static_cast<int>(row_blocks_.size())) row_blocks_.emplace_back();
      Matrix& row = row_blocks_[n_row_blocks_++];
      if (k < i)
        row = pool_[place];
      else
        row = pool_[place].transpose();
      pivots_[k].matrixL().solveInPlace(row);
      rows_.push_back(i);
    }
    row_begin_.push_back(static_cast<int>(rows_.size()));
    for (int e = begin; e < row_begin_.back(); ++e)
      for (int f = e; f < row_begin_.back(); ++f)
        block(rows_[e], rows_[f]).noalias() -= row_blocks_[e].transpose() * row_blocks_[f];
  }

  int n_ = 0;
  int words_ = 0;
  std::vector<int> place_;  ///< position of block (i, j) in pool_, or -1
  std::vector<Matrix, Eigen::aligned_allocator<Matrix>> pool_;
  int used_ = 0;

  std::vector<std::uint64_t> adjacency_;  ///< bit rows
  std::vector<char> eliminated_;
  std::vector<int> sequence_;  ///< blocks in order of elimination
  std::vector<int> rank_;      ///< its inverse

  std::vector<Eigen::LLT<Matrix>> pivots_;
  std::vector<Matrix, Eigen::aligned_allocator<Matrix>> row_blocks_;  ///< U(k, .) off the diagonal
  int n_row_blocks_ = 0;
  std::vector<int> rows_;       ///< column of each of them
  std::vector<int> row_begin_;  ///< per step of the elimination
};

}  // namespace tribound
