/// @file small_dense_test.cpp
/// The kernels against their definitions, entry by entry.

#include "tribound/certify/equilibrate/small_dense.h"

#include <gtest/gtest.h>

#include <random>

namespace tribound::test
{

namespace
{

template <int rows, int cols>
certify::Dense<rows, cols> random_matrix(int seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> entry(-1, 1);
  certify::Dense<rows, cols> matrix;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < cols; ++j) matrix(i, j) = entry(generator);
  return matrix;
}

/// Symmetric and positive definite.
template <int n>
certify::Dense<n, n> definite_matrix()
{
  const certify::Dense<n, n> factor = random_matrix<n, n>(1);
  certify::Dense<n, n> matrix = certify::times_transposed(factor, factor);
  for (int i = 0; i < n; ++i) matrix(i, i) += 1;
  return matrix;
}

template <class Size>
class SmallDense : public ::testing::Test
{
};

template <int n>
using Size = std::integral_constant<int, n>;
/// Blocks of facets of all degrees but the largest, and what is just beside a vector.
using SizesToTest =
    ::testing::Types<Size<1>, Size<3>, Size<4>, Size<6>, Size<8>, Size<9>, Size<10>, Size<18>, Size<30>>;
TYPED_TEST_SUITE(SmallDense, SizesToTest);

TYPED_TEST(SmallDense, TransposedProduct)
{
  constexpr int n = TypeParam::value;
  constexpr int m = 2 * n + 1;
  constexpr int k = n + 2;
  const auto a = random_matrix<k, n>(2);
  const auto b = random_matrix<k, m>(3);
  const auto c = random_matrix<n, m>(4);
  auto result = c;
  certify::subtract_transposed_product<n, certify::padded(m), k>(result.data(), result.stride, a.data(),
                                                                 a.stride, b.data(), b.stride);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < result.stride; ++j)
    {
      double expected = j < m ? c(i, j) : 0;
      for (int l = 0; l < k && j < m; ++l) expected -= a(l, i) * b(l, j);
      EXPECT_NEAR(result(i, j), expected, 1e-14 * n);
    }
}

TYPED_TEST(SmallDense, GramMatrix)
{
  constexpr int n = TypeParam::value;
  constexpr int k = n + 2;
  const auto a = random_matrix<k, n>(2);
  const auto c = random_matrix<n, n>(4);
  auto result = c;
  certify::subtract_gram<n, k>(result.data(), a.data(), a.stride);
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
    {
      double expected = c(i, j);
      for (int l = 0; l < k; ++l) expected -= a(l, i) * a(l, j);
      EXPECT_NEAR(result(i, j), expected, 1e-14 * n);
    }
}

TYPED_TEST(SmallDense, MatrixTimesVector)
{
  constexpr int n = TypeParam::value;
  constexpr int k = n + 2;
  const auto a = random_matrix<k, n>(2);
  const auto x = random_matrix<1, k>(3);
  const auto y = random_matrix<1, n>(4);
  auto transposed = y;
  certify::subtract_transposed_times<k, certify::padded(n)>(transposed.data(), a.data(), a.stride, x.data());
  auto straight = x;
  certify::subtract_times<k, certify::padded(n)>(straight.data(), a.data(), a.stride, y.data());
  for (int i = 0; i < n; ++i)
  {
    double expected = y(0, i);
    for (int l = 0; l < k; ++l) expected -= a(l, i) * x(0, l);
    EXPECT_NEAR(transposed(0, i), expected, 1e-14 * n);
  }
  for (int l = 0; l < k; ++l)
  {
    double expected = x(0, l);
    for (int i = 0; i < n; ++i) expected -= a(l, i) * y(0, i);
    EXPECT_NEAR(straight(0, l), expected, 1e-14 * n);
  }
}

TYPED_TEST(SmallDense, CholeskySolves)
{
  constexpr int n = TypeParam::value;
  const certify::Dense<n, n> matrix = definite_matrix<n>();
  certify::Dense<n, n> factor = matrix;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) factor(i, j) = 17;  // not to be read
  std::array<double, n> reciprocal;
  ASSERT_TRUE(certify::cholesky<n>(factor.data(), factor.stride, reciprocal.data()));

  // U^{-1} U^{-T} b, column by column and all columns at a time
  const auto b = random_matrix<n, 3>(5);
  auto columns = b;
  certify::solve_transposed<n, certify::padded(3)>(factor.data(), factor.stride, reciprocal.data(),
                                                   columns.data(), columns.stride);
  for (int j = 0; j < 3; ++j)
  {
    certify::DenseVector<n> x;
    for (int i = 0; i < n; ++i) x[i] = b(i, j);
    certify::solve_transposed<n>(factor.data(), factor.stride, reciprocal.data(), x.data());
    for (int i = 0; i < n; ++i) EXPECT_NEAR(x[i], columns(i, j), 1e-13);
    certify::solve_upper<n>(factor.data(), factor.stride, reciprocal.data(), x.data());
    for (int i = 0; i < n; ++i)
    {
      double product = 0;
      for (int k = 0; k < n; ++k) product += matrix(i, k) * x[k];
      EXPECT_NEAR(product, b(i, j), 1e-12);
    }
  }
  certify::solve_upper<n, certify::padded(3)>(factor.data(), factor.stride, reciprocal.data(), columns.data(),
                                              columns.stride);
  auto product = b;
  certify::subtract_product<n, certify::padded(3), n>(product.data(), product.stride, matrix.data(),
                                                      matrix.stride, columns.data(), columns.stride);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < product.stride; ++j) EXPECT_NEAR(product(i, j), 0, 1e-12);
}

TYPED_TEST(SmallDense, CholeskyRefusesWhatIsNotDefinite)
{
  constexpr int n = TypeParam::value;
  certify::Dense<n, n> matrix = definite_matrix<n>();
  matrix(n - 1, n - 1) = -1;
  std::array<double, n> reciprocal;
  EXPECT_FALSE(certify::cholesky<n>(matrix.data(), matrix.stride, reciprocal.data()));
}

}  // namespace

}  // namespace tribound::test
