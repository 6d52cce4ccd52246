/// @file quadrature_test.cpp
/// Rules against the closed formula for monomials; position and number of their points.

#include "tribound/fem/quadrature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "tribound/fem/symmetric_rules.h"

namespace tribound::test
{

namespace
{

double factorial(int n)
{
  return std::tgamma(n + 1.0);
}

/// Integral of x^a y^b z^c over the k-simplex: a! b! c! / (a + b + c + k)!.
template <int k>
double exact(const std::array<int, k>& powers)
{
  double value = 1;
  int total = k;
  for (const int power : powers)
  {
    value *= factorial(power);
    total += power;
  }
  return value / factorial(total);
}

/// Calls visit(powers) for all monomials of total degree <= degree.
template <int k, class Visit>
void for_each_monomial(int degree, Visit visit)
{
  std::array<int, k> powers{};
  const auto extend = [&](const auto& self, int i, int rest) -> void
  {
    if (i == k) return visit(powers);
    for (powers[i] = 0; powers[i] <= rest; ++powers[i]) self(self, i + 1, rest - powers[i]);
    powers[i] = 0;
  };
  extend(extend, 0, degree);
}

template <int k>
void expect_exact(int degree)
{
  const fem::Quadrature<k> rule = fem::quadrature<k>(degree);
  for_each_monomial<k>(degree,
                       [&](const std::array<int, k>& powers)
                       {
                         double sum = 0;
                         for (int q = 0; q < rule.size(); ++q)
                         {
                           double value = rule.weights[q];
                           for (int i = 0; i < k; ++i) value *= std::pow(rule.points[q][i], powers[i]);
                           sum += value;
                         }
                         EXPECT_NEAR(sum, exact<k>(powers), 2e-14 * exact<k>(std::array<int, k>{}))
                             << "degree " << degree << " in dimension " << k;
                         EXPECT_NEAR(sum / exact<k>(powers), 1, 1e-10);
                       });
}

template <int k>
void expect_positive_and_inside(int degree)
{
  const fem::Quadrature<k> rule = fem::quadrature<k>(degree);
  ASSERT_EQ(rule.points.size(), rule.weights.size());
  for (int q = 0; q < rule.size(); ++q)
  {
    EXPECT_GT(rule.weights[q], 0);
    EXPECT_GT(rule.points[q].minCoeff(), 0);
    EXPECT_LT(rule.points[q].sum(), 1);
  }
}

/// The barycentric coordinates of a point.
template <int k>
std::array<double, k + 1> lambda_of(const Point<k>& x)
{
  std::array<double, k + 1> lambda;
  lambda[0] = 1 - x.sum();
  for (int i = 0; i < k; ++i) lambda[i + 1] = x[i];
  return lambda;
}

/// Points that differ only by rounding count as one, since 1 - x - y rounds (1 - x does not, for x >= 1/2).
/// Weights in an orbit are exactly equal.
template <int k>
bool is_point_of(const fem::Quadrature<k>& rule, const Point<k>& x, double weight)
{
  constexpr double rounding = k == 1 ? 0 : 1e-15;
  for (int q = 0; q < rule.size(); ++q)
    if (rule.weights[q] == weight && (rule.points[q] - x).cwiseAbs().maxCoeff() <= rounding) return true;
  return false;
}

template <int k>
void expect_symmetric(int degree)
{
  const fem::Quadrature<k> rule = fem::quadrature<k>(degree);
  std::array<int, k + 1> order;
  std::iota(order.begin(), order.end(), 0);
  do
    for (int q = 0; q < rule.size(); ++q)
    {
      const std::array<double, k + 1> lambda = lambda_of<k>(rule.points[q]);
      Point<k> x;
      for (int i = 0; i < k; ++i) x[i] = lambda[order[i + 1]];
      EXPECT_TRUE(is_point_of<k>(rule, x, rule.weights[q])) << "degree " << degree << " in dimension " << k;
    }
  while (std::ranges::next_permutation(order).found);
}

/// The highest degrees in the tables.
constexpr int triangle_reach = 20;
constexpr int tetrahedron_reach = 17;

TEST(Quadrature, ExactForMonomials)
{
  for (int degree = 0; degree <= 22; ++degree)
  {
    expect_exact<1>(degree);
    expect_exact<2>(degree);
  }
  for (int degree = 0; degree <= 19; ++degree) expect_exact<3>(degree);
}

TEST(Quadrature, PositiveWeightsAndPointsInside)
{
  for (int degree = 0; degree <= 22; ++degree)
  {
    expect_positive_and_inside<1>(degree);
    expect_positive_and_inside<2>(degree);
    expect_positive_and_inside<3>(degree);
  }
}

TEST(Quadrature, NoPermutationOfTheVerticesChangesARule)
{
  for (int degree = 0; degree <= 20; ++degree) expect_symmetric<1>(degree);
  for (int degree = 0; degree <= triangle_reach; ++degree) expect_symmetric<2>(degree);
  for (int degree = 0; degree <= tetrahedron_reach; ++degree) expect_symmetric<3>(degree);
}

/// No point is closer to the boundary than a thousandth of the height, so rounding cannot put one on it.
template <int k>
void expect_well_inside(int degree)
{
  double closest = 1;
  for (const Point<k>& x : fem::quadrature<k>(degree).points)
    closest = std::min(closest, std::ranges::min(lambda_of<k>(x)));
  EXPECT_GT(closest, 1e-3) << "degree " << degree << " in dimension " << k;
}

TEST(Quadrature, PointsOfTheTablesAreWellInside)
{
  for (int degree = 0; degree <= triangle_reach; ++degree) expect_well_inside<2>(degree);
  for (int degree = 0; degree <= tetrahedron_reach; ++degree) expect_well_inside<3>(degree);
}

TEST(Quadrature, TablesReachAsFarAsTheyShould)
{
  EXPECT_FALSE(fem::symmetric_rule<2>(triangle_reach).empty());
  EXPECT_TRUE(fem::symmetric_rule<2>(triangle_reach + 1).empty());
  EXPECT_FALSE(fem::symmetric_rule<3>(tetrahedron_reach).empty());
  EXPECT_TRUE(fem::symmetric_rule<3>(tetrahedron_reach + 1).empty());
}

TEST(Quadrature, NumbersOfPoints)
{
  const std::array triangle{1, 1, 3, 6, 6, 7, 12, 15, 16, 19, 25, 28, 33, 37, 42, 49, 60, 60, 73, 73, 79};
  const std::array tetrahedron{1, 1, 4, 8, 14, 14, 24, 35, 46, 59, 79, 96, 145, 145, 213, 213, 290, 290};
  for (int degree = 0; degree <= triangle_reach; ++degree)
  {
    EXPECT_EQ(fem::quadrature<2>(degree).size(), triangle[degree]) << "degree " << degree;
    // The rule with four points of degree 3 and full symmetry has a negative weight.
    const int n = degree / 2 + 1;
    EXPECT_LE(triangle[degree], degree == 3 ? 6 : n * n) << "degree " << degree;
  }
  for (int degree = 0; degree <= tetrahedron_reach; ++degree)
  {
    EXPECT_EQ(fem::quadrature<3>(degree).size(), tetrahedron[degree]) << "degree " << degree;
    const int n = degree / 2 + 1;
    EXPECT_LE(tetrahedron[degree], n * n * n) << "degree " << degree;
  }
}

TEST(Quadrature, OnALineNoRuleWithFewerPointsIsExact)
{
  for (int degree = 0; degree <= 17; ++degree) EXPECT_EQ(fem::quadrature<1>(degree).size(), degree / 2 + 1);
}

TEST(Quadrature, ReferenceRuleHasTheStatedNumberOfPoints)
{
  for (int p = 1; p <= 4; ++p) EXPECT_EQ(fem::quadrature<1>(fem::data_quadrature_degree(p)).size(), p + 3);
}

}  // namespace

}  // namespace tribound::test
