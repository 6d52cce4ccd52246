#include "tribound/problem/interval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_formula.h"

namespace tribound
{
namespace
{

TEST(Interval, OfAPeriodicFunctionHoldsForWideArguments)
{
  RandomFormulas random(40);
  for (int i = 0; i < 20000; ++i)
  {
    const double centre = std::pow(10.0, random.uniform(-3, 17)) * (i % 2 == 0 ? 1 : -1);
    const double radius = std::pow(10.0, random.uniform(-6, 1));
    const problem::Enclosure a = {centre - radius, centre + radius};
    const problem::Enclosure sines = problem::sine(a);
    const problem::Enclosure cosines = problem::cosine(a);
    const bool pole = problem::has_pole_of_tangent(a);
    for (int j = 0; j < 10; ++j)
    {
      const double x = random.uniform(a.lower, a.upper);
      EXPECT_TRUE(sines.contains(std::sin(x))) << a.lower << " " << a.upper;
      EXPECT_TRUE(cosines.contains(std::cos(x))) << a.lower << " " << a.upper;
      EXPECT_TRUE(pole || (std::tan(a.lower) <= std::tan(x) && std::tan(x) <= std::tan(a.upper)));
    }
  }
  EXPECT_LT(problem::sine({0.1, 0.2}).upper, 0.2);
  EXPECT_EQ(problem::sine({0.0, 0.2}).lower, 0.0);
  EXPECT_EQ(problem::sine({1.5, 1.6}).upper, 1.0);
  EXPECT_EQ(problem::cosine({3.1, 3.2}).lower, -1.0);
  EXPECT_FALSE(problem::has_pole_of_tangent({1.6, 4.7}));
  EXPECT_TRUE(problem::has_pole_of_tangent({1.5, 1.6}));
}

TEST(Interval, OfAPowerHoldsForEverySign)
{
  RandomFormulas random(41);
  for (int i = 0; i < 20000; ++i)
  {
    const double centre = random.uniform(-2, 2);
    const double radius = random.uniform(0, 1);
    const problem::Enclosure a = {centre - radius, centre + radius};
    const int n = i % 9;
    const problem::Enclosure power = problem::integer_power(a, n);
    for (int j = 0; j < 5; ++j)
    {
      const double x = random.uniform(a.lower, a.upper);
      ASSERT_TRUE(power.contains(std::pow(x, n))) << x << "^" << n;
    }
    EXPECT_TRUE(power.lower >= 0.0 || n % 2 == 1);
  }
}

TEST(Interval, ArithmeticHoldsRounding)
{
  RandomFormulas random(42);
  const auto number = [&]
  { return std::pow(10.0, random.uniform(-20, 20)) * (random.uniform(0, 1) < 0.5 ? 1 : -1); };
  for (int i = 0; i < 20000; ++i)
  {
    const double a = number();
    const double b = number();
    const auto holds = [](const problem::Enclosure& enclosure, long double value)
    { return enclosure.lower <= value && value <= enclosure.upper; };
    EXPECT_TRUE(holds(problem::exactly(a) + problem::exactly(b), static_cast<long double>(a) + b));
    EXPECT_TRUE(holds(problem::exactly(a) - problem::exactly(b), static_cast<long double>(a) - b));
    EXPECT_TRUE(holds(problem::exactly(a) * problem::exactly(b), static_cast<long double>(a) * b));
    EXPECT_TRUE(holds(problem::exactly(a) / problem::exactly(b), static_cast<long double>(a) / b));
  }
  const problem::Enclosure straddling = {-2, 3};
  EXPECT_EQ((straddling * problem::exactly(0.0)).magnitude(), 0.0);
  EXPECT_NEAR((straddling * straddling).lower, -6, 1e-14);
  EXPECT_NEAR((straddling * straddling).upper, 9, 1e-14);
}

/// inf * 0 is nan, and comparisons lose a nan.
TEST(Interval, AnOverflowIsNotForgotten)
{
  const double infinity = std::numeric_limits<double>::infinity();
  const problem::Enclosure overflown = {1, infinity};
  for (const problem::Enclosure& a :
       {overflown * problem::Enclosure{0, 1}, problem::Enclosure{0, 1} * overflown, overflown / overflown})
    EXPECT_EQ(a.upper, infinity);
}

}  // namespace
}  // namespace tribound
