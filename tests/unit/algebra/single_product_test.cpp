/// @file single_product_test.cpp
/// Products in single precision against those in double precision.

#include "tribound/algebra/single_product.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/fields.h"
#include "tribound/algebra/linear_solver.h"

namespace tribound::test
{

namespace
{

using algebra::detail::SingleProduct;

/// Entries of all magnitudes within eight decades; the rows of a block have different patterns.
algebra::Triplets scattered(int n, double unit, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(0, n - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  algebra::Triplets entries;
  for (int i = 0; i < n; ++i) entries.add(i, i, 3 * unit);
  for (int k = 0; k < 7 * n; ++k)
    entries.add(place(random), place(random), unit * value(random) * std::pow(10, 4 * value(random) - 4));
  return entries;
}

std::vector<double> random_vector(int n, double unit, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-unit, unit);
  std::vector<double> x(n);
  std::ranges::generate(x, [&] { return value(random); });
  return x;
}

/// MatMult(), called as PETSc's solvers call it.
std::vector<double> product(Mat a, const std::vector<double>& x)
{
  std::vector<double> y(x.size());
  using algebra::detail::wrap;
  EXPECT_EQ(MatMult(a, wrap(std::span<const double>(x)).get(), wrap(std::span(y)).get()), 0);
  return y;
}

TEST(SingleProduct, IsThatInDoublePrecisionToSevenDigits)
{
  for (const int block_size : {1, 2, 3, 6})
    for (const double unit : {1.0, 1e-60, 1e90})
    {
      const int n = 20 * 6;
      const algebra::SparseMatrix a(n, block_size, scattered(n, unit, block_size));
      const std::vector<double> x = random_vector(n, 1 / unit, 7);
      const std::vector<double> y = a.multiply(x);
      {
        const SingleProduct single(a.handle());
        EXPECT_LE(distance(product(a.handle(), x), y), 3e-7 * norm(y)) << block_size << ", " << unit;
        EXPECT_GT(distance(product(a.handle(), x), y), 0.0);
        const double rounding = block_size % 3 == 0 ? 1e-14 * norm(y) : 0;  // else the product is PETSc's
        EXPECT_LE(distance(product(single.exact(), x), y), rounding);
        EXPECT_EQ(product(a.handle(), std::vector<double>(n, 0.0)), std::vector<double>(n, 0.0));
      }
      EXPECT_EQ(product(a.handle(), x), y);  // as before
    }
}

TEST(SingleProduct, FollowsTheMatrix)
{
  const int n = 60;
  algebra::Triplets entries = scattered(n, 1, 3);
  algebra::SparseMatrix a(n, 3, entries);
  const std::vector<double> x = random_vector(n, 1, 8);
  algebra::detail::multiply_in_single(a.handle());
  static_cast<void>(product(a.handle(), x));
  std::ranges::reverse(entries.values);
  a.set_values(entries.values);
  algebra::detail::multiply_in_single(a.handle());
  const std::vector<double> y = multiply(entries, x);
  EXPECT_LE(distance(product(a.handle(), x), y), 3e-7 * norm(y));
}

/// A matrix of n x m entries in blocks, a third of which are empty.
algebra::MatHandle scattered_blocks(int n, int m, std::array<int, 2> block, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  std::bernoulli_distribution is_empty(1. / 3);
  algebra::Triplets entries;
  for (int i = 0; i < n; i += block[0])
    for (int j = 0; j < m; j += block[1])
      if (!is_empty(random))
        for (int k = 0; k < block[0] * block[1]; ++k)
          entries.add(i + k / block[1], j + k % block[1], value(random));
  Mat mat = nullptr;
  EXPECT_EQ(MatCreate(algebra::detail::communicator(), &mat), 0);
  EXPECT_EQ(MatSetSizes(mat, n, m, n, m), 0);
  EXPECT_EQ(MatSetType(mat, MATSEQAIJ), 0);
  EXPECT_EQ(MatSetBlockSizes(mat, block[0], block[1]), 0);
  const auto n_entries = static_cast<PetscCount>(entries.rows.size());
  EXPECT_EQ(MatSetPreallocationCOO(mat, n_entries, entries.rows.data(), entries.cols.data()), 0);
  EXPECT_EQ(MatSetValuesCOO(mat, entries.values.data(), INSERT_VALUES), 0);
  return algebra::MatHandle(mat);
}

/// Blocks of nodes have a product of their own, which takes values and pattern from the matrix.
TEST(SingleProduct, WholeBlocksHaveTheSameExactProduct)
{
  const int n = 90;
  const std::vector<double> x = random_vector(n, 1, 4);
  for (const std::array<int, 2> block : {std::array{2, 2}, std::array{3, 3}, std::array{6, 6}})
  {
    const algebra::MatHandle a = scattered_blocks(n, n, block, 5);
    const std::vector<double> y = product(a.get(), x);
    const SingleProduct single(a.get());
    EXPECT_LE(distance(product(single.exact(), x), y), 1e-14 * norm(y)) << block[0];
    EXPECT_EQ(MatScale(a.get(), 2), 0);
    EXPECT_LE(distance(product(single.exact(), x), y), (1 + 1e-14) * norm(y)) << block[0];
    EXPECT_GE(distance(product(single.exact(), x), y), (1 - 1e-14) * norm(y)) << block[0];
    EXPECT_GT(distance(product(a.get(), x), y), 0.0) << block[0];
  }
}

/// Interpolations by aggregation have blocks: components of a node times modes of an aggregate.
TEST(SingleProduct, InterpolatesAndAdds)
{
  using algebra::detail::wrap;
  const int n = 60;
  for (const std::array<int, 2> block : {std::array{3, 6}, {2, 3}, {6, 6}, {3, 2}, {1, 3}, {5, 1}})
  {
    SCOPED_TRACE(testing::Message() << block[0] << " x " << block[1]);
    const int m = 12;
    const algebra::MatHandle p = scattered_blocks(n, m, block, block[1]);
    const std::vector<double> x = random_vector(m, 1e3, 1);
    const std::vector<double> z = random_vector(n, 1e3, 2);
    const auto added = [&](std::vector<double> to, bool in_place)
    {
      std::vector<double> y = to;
      const auto result = wrap(std::span(y));
      const auto before = wrap(std::span<const double>(to));
      EXPECT_EQ(MatMultAdd(p.get(), wrap(x).get(), in_place ? result.get() : before.get(), result.get()), 0);
      return y;
    };
    const std::vector<double> exact = added(z, false);
    const std::vector<double> product_alone = added(std::vector<double>(n, 0.0), false);
    algebra::detail::interpolate_in_single(p.get());
    EXPECT_LE(distance(added(z, false), exact), 3e-7 * norm(product_alone));
    EXPECT_GT(distance(added(z, false), exact), 0.0);
    EXPECT_EQ(added(z, true), added(z, false));
  }
}

TEST(SingleProduct, WhatIsNoNumberStaysNone)
{
  const int n = 60;
  const algebra::SparseMatrix a(n, 3, scattered(n, 1, 4));
  std::vector<double> x = random_vector(n, 1, 9);
  const SingleProduct single(a.handle());
  for (const double value : {std::nan(""), HUGE_VAL})
  {
    x[10] = value;
    EXPECT_FALSE(std::isfinite(norm(product(a.handle(), x))));
  }
}

}  // namespace

}  // namespace tribound::test
