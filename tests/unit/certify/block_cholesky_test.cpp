/// @file block_cholesky_test.cpp
/// Solutions of sparse block systems, put back into the system.

#include "tribound/certify/equilibrate/block_cholesky.h"

#include <gtest/gtest.h>

#include <random>
#include <span>
#include <vector>

namespace tribound::test
{

namespace
{

constexpr int size = 3;
constexpr int large = 13;
using Edges = std::vector<std::array<int, 2>>;

/// Blocks (i, j) of the edges are random, those on the diagonal dominate. Returns |A x - b| for a random b,
/// which is also the last of several columns solved for at a time.
template <int size>
double largest_defect(int n_blocks, const Edges& edges, certify::BlockCholesky<size>& matrix)
{
  std::mt19937 generator(n_blocks);
  std::uniform_real_distribution<double> entry(-1, 1);
  matrix.reset(n_blocks);
  for (const auto& [i, j] : edges) matrix.connect(i, j);
  const std::span<const int> name = matrix.order();

  const int n = size * n_blocks;
  std::vector<std::vector<double>> full(n, std::vector<double>(n, 0.0));
  for (int k = 0; k < n; ++k)
  {
    full[k][k] = n;
    matrix.block(k / size, k / size)(k % size, k % size) = n;
  }
  for (const auto& [i, j] : edges)
  {
    const int row = std::min(name[i], name[j]);
    const int column = std::max(name[i], name[j]);
    for (int r = 0; r < size; ++r)
      for (int c = 0; c < size; ++c)
        full[row * size + r][column * size + c] = full[column * size + c][row * size + r] =
            matrix.block(row, column)(r, c) = entry(generator);
  }

  std::vector<certify::DenseVector<size>> x(n_blocks);
  for (auto& block : x)
    for (int r = 0; r < size; ++r) block[r] = entry(generator);
  const auto b = x;
  std::vector<certify::Dense<size, 2>> columns(n_blocks);
  for (int i = 0; i < n_blocks; ++i)
    for (int r = 0; r < size; ++r) columns[i](r, 1) = b[i][r];
  EXPECT_TRUE(matrix.factor());
  matrix.solve(x);
  matrix.solve(std::span(columns));
  for (int i = 0; i < n_blocks; ++i)
    for (int r = 0; r < size; ++r)
    {
      EXPECT_EQ(columns[i](r, 0), 0);
      EXPECT_NEAR(columns[i](r, 1), x[i][r], 1e-15);
    }
  double largest = 0;
  for (int i = 0; i < n; ++i)
  {
    double defect = -b[i / size][i % size];
    for (int j = 0; j < n; ++j) defect += full[i][j] * x[j / size][j % size];
    largest = std::max(largest, std::abs(defect));
  }
  return largest;
}

Edges cycle(int n)
{
  Edges edges;
  for (int i = 0; i < n; ++i) edges.push_back({i, (i + 1) % n});
  return edges;
}

template <int size>
void solve_on_graphs()
{
  certify::BlockCholesky<size> matrix;  // storage is used again
  EXPECT_LE(largest_defect(1, {}, matrix), 1e-14);
  EXPECT_LE(largest_defect(4, {{2, 0}, {0, 3}, {3, 1}}, matrix), 1e-14);
  for (const int n : {3, 6, 7, 70})  // 70: two words of a bit row
  {
    EXPECT_LE(largest_defect(n, cycle(n), matrix), 1e-13) << n;
    Edges wheel = cycle(n);
    for (int i = 0; i < n; ++i) wheel.push_back({n, i});
    EXPECT_LE(largest_defect(n + 1, wheel, matrix), 1e-13) << n;
  }
}

}  // namespace

TEST(BlockCholesky, SolvesOnPathsCyclesAndWheels)
{
  solve_on_graphs<size>();
}

TEST(BlockCholesky, SolvesWithLargeBlocks)
{
  solve_on_graphs<large>();
}

/// Two complete graphs of five blocks with a block between one of each: its few neighbours are eliminated
/// after others of their own graphs.
TEST(BlockCholesky, LargeBlocksAreOrderedByFill)
{
  Edges edges = {{0, 10}, {10, 5}};
  for (const int first : {0, 5})
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < i; ++j) edges.push_back({first + i, first + j});
  certify::BlockCholesky<large> matrix;
  EXPECT_LE(largest_defect(11, edges, matrix), 1e-13);
  EXPECT_EQ(matrix.bytes(), (11 + edges.size()) * sizeof(certify::BlockCholesky<large>::Matrix));
}

TEST(BlockCholesky, RefusesASingularMatrix)
{
  certify::BlockCholesky<size> matrix;
  matrix.reset(2);
  matrix.connect(0, 1);
  EXPECT_EQ(matrix.order().size(), 2U);
  EXPECT_FALSE(matrix.factor());
}

TEST(BlockCholesky, ClearedItIsZeroAndKeepsItsConnections)
{
  certify::BlockCholesky<size> matrix;
  matrix.reset(2);
  matrix.connect(0, 1);
  EXPECT_EQ(matrix.order().size(), 2U);
  std::array<certify::DenseVector<size>, 2> x;
  for (const double diagonal : {2.0, 4.0})
  {
    matrix.clear();
    for (int r = 0; r < size; ++r) matrix.block(0, 0)(r, r) = matrix.block(1, 1)(r, r) = diagonal;
    if (diagonal == 2) matrix.block(0, 1)(0, 0) = 1;
    EXPECT_TRUE(matrix.factor());
    for (auto& block : x)
      for (int r = 0; r < size; ++r) block[r] = 1;
    matrix.solve(x);
  }
  for (const auto& block : x)
    for (int r = 0; r < size; ++r) EXPECT_EQ(block[r], 0.25);
}

TEST(BlockCholesky, DecouplesRowsAndColumns)
{
  certify::BlockCholesky<size> matrix;
  matrix.reset(2);
  matrix.connect(0, 1);
  EXPECT_EQ(matrix.order().size(), 2U);
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size; ++c)
    {
      matrix.block(0, 0)(r, c) = matrix.block(1, 1)(r, c) = r == c ? 4 : 1;
      matrix.block(0, 1)(r, c) = 0.5;
    }
  matrix.decouple<2>(1, 0);
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size; ++c)
    {
      EXPECT_EQ(matrix.block(0, 1)(r, c), c < 2 ? 0 : 0.5);
      EXPECT_EQ(matrix.block(1, 1)(r, c), r == c ? 4 : 0);
      EXPECT_EQ(matrix.block(0, 0)(r, c), r == c ? 4 : 1);
    }
}

}  // namespace tribound::test
