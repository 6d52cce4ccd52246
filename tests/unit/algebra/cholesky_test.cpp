/// @file cholesky_test.cpp
/// Which symmetric matrices are positive definite. The string with n inner nodes has the eigenvalues
/// 2 - 2 cos(k pi / (n + 1)).

#include "tribound/algebra/cholesky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tribound/base/norm.h"

namespace tribound::test
{

namespace
{

/// tridiag(-1, 2, -1) - shift.
algebra::SparseMatrix string_matrix(int n, double shift)
{
  algebra::Triplets entries;
  for (int i = 0; i < n; ++i)
  {
    entries.add(i, i, 2 - shift);
    if (i == 0) continue;
    entries.add(i, i - 1, -1);
    entries.add(i - 1, i, -1);
  }
  return {n, 1, entries};
}

double eigenvalue(int n, int k)
{
  return 2 - 2 * std::cos(k * std::numbers::pi / (n + 1));
}

TEST(SparseCholesky, Solves)
{
  const algebra::SparseMatrix a = string_matrix(50, 0);
  const algebra::SparseCholesky cholesky(a, 2);
  ASSERT_TRUE(cholesky.positive_definite());
  std::vector<double> b(50);
  for (int i = 0; i < 50; ++i) b[i] = std::sin(i);
  std::vector<double> x(50);
  cholesky.solve(b, x);
  std::vector<double> residual = a.multiply(x);
  for (int i = 0; i < 50; ++i) residual[i] -= b[i];
  EXPECT_LE(norm(residual), 1e-12);
}

TEST(SparseCholesky, TellsDefiniteFromIndefinite)
{
  for (const int dim : {2, 3})
    for (const int n : {1, 2, 50, 3000})
    {
      EXPECT_TRUE(
          algebra::SparseCholesky(string_matrix(n, (1 - 1e-6) * eigenvalue(n, 1)), dim).positive_definite());
      EXPECT_FALSE(
          algebra::SparseCholesky(string_matrix(n, (1 + 1e-6) * eigenvalue(n, 1)), dim).positive_definite());
      EXPECT_FALSE(
          algebra::SparseCholesky(string_matrix(n, 1e-6 + eigenvalue(n, n)), dim).positive_definite());
    }
}

TEST(SparseCholesky, RefusesZeroPivotsAndWhatIsNoNumber)
{
  EXPECT_FALSE(algebra::SparseCholesky(string_matrix(1, 2), 2).positive_definite());
  EXPECT_FALSE(algebra::SparseCholesky(string_matrix(4, 2), 2).positive_definite());
  EXPECT_FALSE(algebra::SparseCholesky(string_matrix(5, 2), 3).positive_definite());
  EXPECT_FALSE(algebra::SparseCholesky(string_matrix(4, std::numeric_limits<double>::quiet_NaN()), 2)
                   .positive_definite());
}

}  // namespace

}  // namespace tribound::test
