#include "tribound/contact/nitsche/datum_moments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tribound/fem/polynomials.h"

namespace tribound::test
{

namespace
{

constexpr double pi = std::numbers::pi;
constexpr contact::DatumWeights weights{1, 1};

problem::Field formula(const std::string& text)
{
  return {text, Where{.key = "test"}};
}

/// The segment from (0, 0) to (length, 0), the triangle and the tetrahedron at the origin with legs `length`.
template <int k, int dim>
contact::SimplexMap<k, dim> simplex(double length)
{
  contact::SimplexMap<k, dim> map;
  map.origin.setZero();
  map.jacobian.setZero();
  map.measure = 1;
  for (int i = 0; i < k; ++i)
  {
    map.jacobian(i, i) = length;
    map.measure *= length / (i + 1);
  }
  return map;
}

/// The scalar formula in component 0.
template <int k, int dim>
contact::DatumOnSimplex<k, dim> looked_into(const problem::Field& f, double length, double allowed, int p = 2,
                                            int parts = 4096)
{
  const contact::DatumMoments<k, dim> moments(p, k == dim ? p - 1 : p);
  return moments({{{&f, Point<dim>::Unit(0)}}}, simplex<k, dim>(length), weights, allowed, parts);
}

/// The integral over the simplex. theta_0 is the square root of k!, the reciprocal of its measure.
template <int k, int dim>
double integral(const contact::DatumOnSimplex<k, dim>& found, double length)
{
  constexpr double factorial = k == 3 ? 6 : k;
  return found.moments[0][0] / std::sqrt(factorial) * factorial * simplex<k, dim>(length).measure;
}

TEST(DatumMoments, PolynomialsAreLeftToTheRule)
{
  const auto found = looked_into<2, 2>(formula("x^4 - x*y^3 + 2"), 1, 0);
  EXPECT_FALSE(found.is_subdivided());
  EXPECT_EQ(found.mean, 0);
  EXPECT_GT(found.oscillation, 0);
  EXPECT_LE((looked_into<2, 2>(formula("3*x - y"), 1, 0).oscillation), 1e-15);
}

/// int_0^1 (f - Pi^1 f)^2 for a step at a: a (1 - a) - 3 a^2 (1 - a)^2.
TEST(DatumMoments, StepsAreCutExactly)
{
  for (const double a : {0.003, 0.26, 0.5, 0.999})
  {
    const auto found = looked_into<1, 2>(formula(std::to_string(a) + " < x"), 1, 0, 1);
    EXPECT_EQ(found.parts.size(), 2U);
    EXPECT_NEAR((integral<1, 2>(found, 1)), 1 - a, 1e-15);
    EXPECT_LE(found.mean, 1e-15);
    EXPECT_NEAR(std::pow(found.oscillation, 2), a * (1 - a) - 3 * std::pow(a * (1 - a), 2), 3e-14);
  }
}

TEST(DatumMoments, StripsBetweenThePointsOfTheRuleAreSeen)
{
  const auto found = looked_into<1, 2>(formula("x > 0.26 && x < 0.261 ? -1 : 0"), 0.5, 0);
  EXPECT_EQ(found.parts.size(), 3U);
  EXPECT_NEAR((integral<1, 2>(found, 0.5)), -0.001, 1e-16);
}

TEST(DatumMoments, PlanesCutTetrahedra)
{
  // x + y + z < 1/2 is 1/8 of the unit tetrahedron; then a slab with x < 0.2.
  const auto corner = looked_into<3, 3>(formula("x + y + z < 0.5 ? 8 : 0"), 1, 0, 1);
  EXPECT_NEAR((integral<3, 3>(corner, 1)), 1.0 / 6, 1e-15);
  EXPECT_LE(corner.mean, 1e-15);
  const auto slab = looked_into<3, 3>(formula("x < 0.2 && y > 0.1"), 1, 0, 2);
  const auto beyond = [](double x, double y) { return std::pow(1 - x - y, 3) / 6; };
  EXPECT_NEAR((integral<3, 3>(slab, 1)), beyond(0, 0.1) - beyond(0.2, 0.1), 1e-15);
}

/// Kinks in planes.
TEST(DatumMoments, KinksAreCutExactly)
{
  const auto found = looked_into<2, 2>(formula("max(0, 9*(0.3 - y)) + abs(x - 0.5)"), 1, 0);
  const auto third = [](double c) { return c * c * c / 3; };
  // int (0.3 - y)_+ (1 - y) dy and int |x - 0.5| (1 - x) dx.
  const double hat = 9 * (0.045 * 0.7 + third(0.3));
  EXPECT_NEAR((integral<2, 2>(found, 1)), hat + 0.125, 1e-15);
  EXPECT_LE(found.mean, 1e-14);
}

TEST(DatumMoments, OscillationsAreResolvedUpToAKnownRest)
{
  for (const double allowed : {1e-1, 1e-3, 1e-6})
  {
    const auto found = looked_into<1, 2>(formula("sin(200*x)"), 1, allowed);
    const double exact = (1 - std::cos(200.0)) / 200;
    EXPECT_LE(std::abs(integral<1, 2>(found, 1) - exact), found.mean + 1e-14);
    EXPECT_LE(found.mean, allowed);
    EXPECT_GE(found.oscillation, std::sqrt(0.5 - std::sin(400.0) / 800) * 0.99);
    EXPECT_LE(found.oscillation, std::sqrt(0.5) + allowed + 0.01);
  }
}

TEST(DatumMoments, SmoothFormulasNeedNoParts)
{
  const auto found = looked_into<2, 2>(formula("exp(x)*sin(3*y)"), 0.125, 1e-4);
  EXPECT_FALSE(found.is_subdivided());
  EXPECT_LE(found.mean, 1e-10);
}

/// A quarter of a disc and an eighth of a ball. The remainder bounds the error and shrinks with more parts.
TEST(DatumMoments, CurvedStepsLeaveARest)
{
  double last = 1;
  for (const int parts : {64, 512, 4096})
  {
    const auto disc = looked_into<2, 2>(formula("x^2 + y^2 < 0.25"), 1, 0, 2, parts);
    const double missed = std::abs(integral<2, 2>(disc, 1) - pi / 16);
    EXPECT_LE(missed, disc.mean);
    EXPECT_LE(disc.mean, last / 4);
    last = disc.mean;
  }
  const auto ball = looked_into<3, 3>(formula("x^2 + y^2 + z^2 < 0.16"), 1, 0, 1, 4096);
  EXPECT_LE((std::abs(integral<3, 3>(ball, 1) - pi / 6 * 0.064)), ball.mean);
  EXPECT_LE(ball.mean, 0.02);
}

TEST(DatumMoments, WhatCannotBeBoundedIsRefused)
{
  try
  {
    (void)looked_into<1, 2>(formula("1/sqrt(x)"), 1, 1e-3, 2, 200);
    FAIL() << "1/sqrt(x) is not bounded near 0";
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("may be unbounded near the point ("));
  }
}

/// Values between 4 and 333. Intervals show that on small parts only, even if few parts are worth the effort.
TEST(DatumMoments, ABoundedFormulaIsNotRefusedForTheEffort)
{
  for (const int parts : {64, 406, 4096})
  {
    const auto found = looked_into<2, 2>(formula("1/(x^2 - x + 0.253)"), 1, 1e-3, 1, parts);
    EXPECT_TRUE(std::isfinite(found.mean));
    // int_0^1 (1 - x)/((x - 1/2)^2 + 0.003) dx
    const double exact = std::atan(0.5 / std::sqrt(0.003)) / std::sqrt(0.003);
    EXPECT_NEAR((integral<2, 2>(found, 1)), exact, found.mean + 1e-12);
  }
}

/// More switches than parts: those that are not cut leave a remainder.
TEST(DatumMoments, ManySwitchesAreCutUpToALimit)
{
  std::string text = "0";
  for (int i = 1; i < 200; ++i)
    text += " + (" + std::to_string(i) + "*x + y < " + std::to_string(0.4 * i) + ")";
  const auto found = looked_into<2, 2>(formula(text), 1, 0, 2, 256);
  EXPECT_LE(found.parts.size(), 2048U);
  double exact = 0;  // areas of i x + y < 0.4 i in the triangle, by a fine sum
  constexpr int n = 20000;
  for (int i = 1; i < 200; ++i)
    for (int j = 0; j < n; ++j)
    {
      const double y = (j + 0.5) / n;
      exact += std::clamp(0.4 - y / i, 0.0, 1 - y) / n;
    }
  EXPECT_LE((std::abs(integral<2, 2>(found, 1) - exact)), found.mean + 1e-6 * exact);
}

TEST(DatumMoments, TheirPolynomialHasTheSameMoments)
{
  const contact::DatumMoments<2, 2> moments(2, 1);
  const problem::Field f = formula("x > 0.123 ? y : 0");
  const auto found = moments({{{&f, Point<2>(1, 2)}}}, simplex<2, 2>(1), weights, 0, 100);
  std::vector<Point<2>> values(moments.rule().size());
  moments.evaluate(found.moments, values);
  std::vector<double> theta(fem::polynomial_dimension(2, 3));
  std::vector<Point<2>> again(theta.size(), Point<2>::Zero());
  for (int q = 0; q < moments.rule().size(); ++q)
  {
    fem::orthonormal_values<2>(3, moments.rule().points[q], theta);
    for (std::size_t j = 0; j < theta.size(); ++j)
      again[j] += moments.rule().weights[q] * theta[j] * values[q];
  }
  for (std::size_t j = 0; j < theta.size(); ++j) EXPECT_LE((again[j] - found.moments[j]).norm(), 1e-14);
}

}  // namespace

}  // namespace tribound::test
