/// @file petsc_test.cpp
/// Sparse matrices against dense ones.

#include "tribound/algebra/petsc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/fields.h"
#include "tribound/algebra/petsc_detail.h"
#include "tribound/algebra/sparse_rows.h"
#include "tribound/base/error.h"

namespace tribound::test
{

namespace
{

/// Random entries, with repetitions and some that are ignored.
algebra::Triplets random_entries(int n, int count, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(-1, n - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  algebra::Triplets entries;
  for (int i = 0; i < n; ++i) entries.add(i, i, 3.0 + i);
  for (int k = 0; k < count; ++k) entries.add(place(random), place(random), value(random));
  return entries;
}

std::vector<double> ramp(int n)
{
  std::vector<double> x(n);
  for (int i = 0; i < n; ++i) x[i] = 0.3 * i - 1;
  return x;
}

/// On a processor that it does not know, OpenBLAS takes kernels for processors without AVX2.
TEST(Blas, RunsTheKernelsOfTheProcessor)
{
  const std::string library = algebra::blas_facts().library;
  EXPECT_THAT(library, ::testing::HasSubstr("blas"));
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && std::getenv("OPENBLAS_CORETYPE") == nullptr)
  {
    EXPECT_THAT(library, ::testing::Not(::testing::HasSubstr("Prescott")));
  }
#endif
}

TEST(SparseMatrix, SumsEntriesAndSkipsNegativePlaces)
{
  algebra::Triplets entries;
  entries.add(0, 0, 1);
  entries.add(0, 0, 2);
  entries.add(1, 1, 1);
  entries.add(0, 1, 5);
  entries.add(-1, 1, 100);
  entries.add(1, -1, 100);
  const algebra::SparseMatrix a(2, 1, entries);
  EXPECT_EQ(a.size(), 2);
  EXPECT_EQ(a.multiply(std::vector{1.0, 10.0}), (std::vector{53.0, 10.0}));
  EXPECT_EQ(a.diagonal(), (std::vector{3.0, 1.0}));
}

TEST(SparseMatrix, MultipliesLikeItsEntries)
{
  const algebra::Triplets entries = random_entries(30, 400, 1);
  const algebra::SparseMatrix a(30, 3, entries);
  EXPECT_LE(distance(a.multiply(ramp(30)), multiply(entries, ramp(30))), 1e-12);
}

TEST(SparseMatrix, TakesNewValuesInTheSameOrder)
{
  algebra::Triplets entries = random_entries(30, 400, 2);
  algebra::SparseMatrix a(30, 3, entries);
  for (double& value : entries.values) value = 1 - 2 * value;
  a.set_values(entries.values);
  EXPECT_LE(distance(a.multiply(ramp(30)), multiply(entries, ramp(30))), 1e-12);
}

TEST(SparseMatrix, CopiesAreIndependent)
{
  const algebra::Triplets entries = random_entries(12, 40, 3);
  algebra::SparseMatrix a(12, 2, entries);
  const algebra::SparseMatrix copy = a.duplicate();
  a.set_values(std::vector<double>(entries.values.size(), 0.0));
  EXPECT_LE(distance(copy.multiply(ramp(12)), multiply(entries, ramp(12))), 1e-12);
  EXPECT_EQ(norm(a.multiply(ramp(12))), 0);
}

TEST(SparseMatrix, SumHasBothPatterns)
{
  const algebra::Triplets large = random_entries(30, 300, 4);
  algebra::Triplets part;
  for (std::size_t k = 0; k < large.values.size(); k += 5)
    part.add(large.rows[k], large.cols[k], 7.0 + static_cast<double>(k));
  const algebra::SparseMatrix a(30, 3, large);
  for (const algebra::Triplets& other : {part, random_entries(30, 100, 5)})
  {
    algebra::SparseMatrix b(30, 3, other);
    algebra::SparseMatrix c = algebra::SparseMatrix::sum(a, b);
    EXPECT_LE(distance(c.multiply(ramp(30)), sum(a.multiply(ramp(30)), 1, b.multiply(ramp(30)))), 1e-10);
    for (double factor = 1; factor < 4; ++factor)
    {
      std::vector<double> values = other.values;
      for (double& value : values) value *= factor;
      b.set_values(values);
      c.assign_sum(a, b);
      const std::vector<double> expected = sum(multiply(large, ramp(30)), factor, multiply(other, ramp(30)));
      EXPECT_LE(distance(c.multiply(ramp(30)), expected), 1e-10);
    }
  }
}

/// What SolveError says of a count.
template <class Require>
std::string refusal(const Require& require, std::int64_t count)
{
  try
  {
    require(count);
  }
  catch (const SolveError& error)
  {
    return error.what();
  }
  return {};
}

TEST(SparseMatrix, CountsThatNumbersCannotHoldAreRefused)
{
  const auto entries = [](std::int64_t n) { algebra::require_countable(n); };
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  EXPECT_EQ(refusal(entries, most), "");
  EXPECT_EQ(refusal(entries, most + 1),
            "the matrix of a process has 2147483648 entries, at most 2147483647 can be counted with 32 bits: "
            "take more processes or fewer unknowns");
  constexpr std::int64_t most_rows = std::numeric_limits<PetscInt>::max();
  EXPECT_EQ(refusal(algebra::detail::require_numbered, most_rows), "");
  if constexpr (most_rows == most)
  {
    EXPECT_EQ(refusal(algebra::detail::require_numbered, 3'000'000'000),
              "the matrix has 3000000000 rows, of which this PETSc can number 2147483647: lower "
              "adapt.max_dofs or raise the tolerance");
  }
}

TEST(SparseMatrix, RowsOfManyRanksAreNumberedBeyond32Bits)
{
  fem::NodeNumbers nodes;
  nodes.first = 3'000'000'000;
  nodes.n = 4'000'000'000;
  nodes.owned = {1};
  nodes.global = {2'999'999'999, 3'000'000'000};
  EXPECT_FALSE(algebra::detail::is_owned(nodes, 3, 2));
  EXPECT_TRUE(algebra::detail::is_owned(nodes, 3, 3));
}

TEST(AlgebraVersions, AreKnown)
{
  const algebra::AlgebraVersions versions = algebra::algebra_versions();
  for (const std::string& text : {versions.petsc, versions.mumps, versions.mpi, versions.blas.library})
    EXPECT_FALSE(text.empty());
}

}  // namespace

}  // namespace tribound::test
