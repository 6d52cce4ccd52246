/// @file quadrature_test.cpp
/// Rules against the closed formula for monomials.

#include "tribound/fem/quadrature.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

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

TEST(Quadrature, ExactForMonomials)
{
  for (int degree = 0; degree <= 17; ++degree)
  {
    expect_exact<1>(degree);
    expect_exact<2>(degree);
  }
  for (int degree = 0; degree <= 13; ++degree) expect_exact<3>(degree);
}

TEST(Quadrature, PositiveWeightsAndPointsInside)
{
  for (int degree = 0; degree <= 17; ++degree)
  {
    expect_positive_and_inside<1>(degree);
    expect_positive_and_inside<2>(degree);
    expect_positive_and_inside<3>(degree);
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
