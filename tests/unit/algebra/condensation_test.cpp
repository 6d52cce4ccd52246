/// @file condensation_test.cpp
/// Static condensation against dense algebra that eliminates the unknowns one block at a time.

#include "tribound/algebra/condensation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/base/error.h"

namespace tribound::test
{

namespace
{

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int n = 30;
const std::vector<Index> layer{4, 0, 17, 29};  // in no particular order
const std::vector<Index> trace{9, 25, 3, 11, 10};

std::vector<double> values(const Vector& v)
{
  return {v.begin(), v.end()};
}
Vector vector(std::span<const double> v)
{
  return Eigen::Map<const Vector>(v.data(), static_cast<Eigen::Index>(v.size()));
}

Vector random_vector(int size, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Vector::NullaryExpr(size, [&] { return uniform(random); });
}

/// The stiffness of springs between random unknowns: one rigid mode, all ones; plus `ground` on the diagonal.
Matrix springs(double ground)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> stiffness(0.5, 2);
  Matrix k = Matrix::Identity(n, n) * ground;
  const auto connect = [&](int i, int j)
  {
    const double c = stiffness(random);
    k(i, i) += c;
    k(j, j) += c;
    k(i, j) -= c;
    k(j, i) -= c;
  };
  for (int i = 0; i + 1 < n; ++i) connect(i, i + 1);
  for (int e = 0; e < 60; ++e)
    if (const int i = static_cast<int>(random() % n), j = static_cast<int>(random() % n); i != j)
      connect(i, j);
  return k;
}

algebra::SparseRows rows(const Matrix& a)
{
  algebra::SparseRows result;
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
      if (a(i, j) != 0) result.add(j, a(i, j));
    result.end_row();
  }
  return result;
}

/// K u = b + f with f on the trace: f = S x - g and u for the given x on the trace.
struct Reference
{
  Reference(const Matrix& k, const Vector& b, const Vector& x) : u(n)
  {
    std::vector<Index> rest;
    for (Index i = 0; i < n; ++i)
      if (std::ranges::find(trace, i) == trace.end()) rest.push_back(i);
    u(trace) = x;
    const Vector r = b(rest) - k(rest, trace) * x;
    u(rest) = CholeskyFactors(k(rest, rest)).solve(r);
    f = (k * u - b)(trace);
  }
  Vector u;
  Vector f;
};

TEST(Condensation, IsTheWholeProblemOnTheTrace)
{
  for (const double ground : {0.0, 1e-3, 1.0})  // with 0 only forces on the trace can hold it
  {
    const Matrix k = springs(ground);
    algebra::Condensation condensed(2, rows(k), layer, trace, values(random_vector(n, 1)));
    for (const unsigned seed : {1U, 2U, 3U})
    {
      const Vector b = random_vector(n, seed);
      if (seed > 1) condensed.set_load(values(b));
      const Vector x = random_vector(static_cast<int>(trace.size()), 10 + seed);
      const Reference exact(k, b, x);
      EXPECT_LE((vector(condensed.multiply(values(x))) - vector(condensed.load()) - exact.f).norm(), 1e-12);
      Vector near(n);
      near(layer) = exact.u(layer);
      near(trace) = x;
      EXPECT_LE(
          (vector(condensed.near(values(x))) - vector(condensed.on_layer_and_trace(values(near)))).norm(),
          1e-12);
      EXPECT_LE((vector(condensed.expand(values(x))) - exact.u).norm(), 1e-12);
    }
  }
}

/// Entries with rows on the trace and columns on trace and layer; some occur twice, some are ignored.
algebra::Triplets forces_on_trace()
{
  std::mt19937 random(5);
  algebra::Triplets entries;
  for (int e = 0; e < 40; ++e)
  {
    const std::size_t column = random() % (trace.size() + layer.size());
    const Index j = column < trace.size() ? trace[column] : layer[column - trace.size()];
    entries.add(e % 7 == 0 ? -1 : trace[random() % trace.size()], e % 5 == 0 ? -1 : j,
                0.3 + 1e-3 * static_cast<double>(random() % 1000));
  }
  for (const Index i : trace) entries.add(i, i, 10.0);
  return entries;
}

TEST(Condensation, SolvesWithForcesOfTraceAndLayer)
{
  const Matrix k = springs(0);
  const Vector b = random_vector(n, 1);
  const algebra::Condensation condensed(2, rows(k), layer, trace, values(b));
  const algebra::Triplets contact = forces_on_trace();
  Matrix tangent = k;
  for (std::size_t e = 0; e < contact.rows.size(); ++e)
    if (contact.rows[e] >= 0 && contact.cols[e] >= 0)
      tangent(contact.rows[e], contact.cols[e]) += contact.values[e];
  const Vector r = random_vector(static_cast<int>(trace.size()), 4);
  Vector whole = Vector::Zero(n);
  whole(trace) = r;
  const Vector d = solve_regular(tangent, whole);
  EXPECT_LE((vector(condensed.solve(contact, values(r), 1e-14)) - d(trace)).norm(), 1e-12 * d.norm());
}

TEST(Condensation, SolvesSeveralWholeProblems)
{
  const Matrix k = springs(1);
  const algebra::Condensation condensed(2, rows(k), {}, trace, std::vector<double>(n, 0.0));
  const std::vector<std::vector<double>> loads = {values(random_vector(n, 1)), values(random_vector(n, 2)),
                                                  values(random_vector(n, 3))};
  const Vector at_rest = Vector::Zero(static_cast<int>(trace.size()));
  for (const std::size_t count : {loads.size(), std::size_t{1}, loads.size()})  // also after one another
  {
    const auto some = std::span(loads).first(count);
    const std::vector<std::vector<double>> whole = condensed.solve_whole(some);
    const std::vector<std::vector<double>> held = condensed.solve_held(some);
    ASSERT_EQ(whole.size(), count);
    ASSERT_EQ(held.size(), count);
    for (std::size_t j = 0; j < count; ++j)
    {
      const Vector b = vector(loads[j]);
      EXPECT_LE((k * vector(whole[j]) - b).norm(), 1e-12 * b.norm());
      EXPECT_LE((vector(held[j]) - Reference(k, b, at_rest).u).norm(), 1e-12 * b.norm());
    }
  }
}

TEST(Condensation, RefusesWhatIsSingular)
{
  const std::vector<double> b(n, 1.0);
  const algebra::Condensation condensed(2, rows(springs(0)), layer, trace, b);
  const std::vector<double> r(trace.size(), 1.0);
  EXPECT_THROW((void)condensed.solve({}, r, 1e-14), SolveError);  // nothing holds the rigid mode
  EXPECT_THROW(algebra::Condensation(2, rows(springs(-3.0)), layer, trace, b), SolveError);
}

}  // namespace

}  // namespace tribound::test
