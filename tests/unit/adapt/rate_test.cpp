/// Rates of quantities with known power-law behaviour.

#include "tribound/adapt/rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribound::test
{

namespace
{

std::vector<adapt::RatePoint> power(double exponent, const std::vector<double>& dofs)
{
  std::vector<adapt::RatePoint> points;
  for (const double n : dofs) points.push_back({n, 3 * std::pow(n, exponent)});
  return points;
}

TEST(Rate, OfAPower)
{
  const std::vector<adapt::RatePoint> points = power(-0.75, {10, 35, 70, 300, 1000});
  EXPECT_NEAR(*adapt::rate_between(points[0], points[1]), -0.75, 1e-14);
  EXPECT_NEAR(*adapt::fitted_rate(points), -0.75, 1e-14);
}

/// The last half is levels 2 to 4 of five, 3 to 5 of six.
TEST(Rate, FittedOverTheLastHalf)
{
  for (const std::size_t n : {5, 6})
  {
    std::vector<adapt::RatePoint> points = power(-0.5, {10, 20, 40, 80, 160, 320});
    points.resize(n);
    points[0].value = 1000;
    points[1].value = 1e-3;
    EXPECT_NEAR(*adapt::fitted_rate(points), -0.5, 1e-14);
    points[n - 3].value *= 2;
    EXPECT_GT(std::abs(*adapt::fitted_rate(points) + 0.5), 0.1);
  }
}

/// Points (0, 0), (1, 1), (2, 1), (3, 2), (4, 4) in logarithms: the line through the last three has slope
/// 3/2.
TEST(Rate, IsTheLeastSquaresSlope)
{
  std::vector<adapt::RatePoint> points;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{0, 0}, {1, 1}, {2, 1}, {3, 2}, {4, 4}})
    points.push_back({std::exp(x), std::exp(y)});
  EXPECT_NEAR(*adapt::fitted_rate(points), 1.5, 1e-14);
}

TEST(Rate, BetweenTwoPointsAPowerLaw)
{
  const std::vector<adapt::RatePoint> points{{10, 8}, {40, 4}, {160, 1}};
  EXPECT_EQ(adapt::value_at(points, 10), 8);
  EXPECT_NEAR(adapt::value_at(points, 20).value(), 8 / std::sqrt(2), 1e-14);
  EXPECT_EQ(adapt::value_at(points, 40), 4);
  EXPECT_NEAR(adapt::value_at(points, 80).value(), 2, 1e-14);
  EXPECT_EQ(adapt::value_at(points, 160), 1);
  EXPECT_FALSE(adapt::value_at(points, 9));
  EXPECT_FALSE(adapt::value_at(points, 161));
  EXPECT_FALSE(adapt::value_at({}, 10));
}

TEST(Rate, UnknownWhereThereIsNone)
{
  EXPECT_FALSE(adapt::fitted_rate({}));
  EXPECT_FALSE(adapt::fitted_rate(std::vector<adapt::RatePoint>{{10, 1}, {20, 0.5}}))
      << "any two points are on a line";
  EXPECT_FALSE(adapt::rate_between({10, 1}, {10, 0.5}));
  EXPECT_FALSE(adapt::rate_between({10, 1}, {20, 0}));
}

}  // namespace

}  // namespace tribound::test
