/// @file surface_test.cpp
/// Surfaces by formulas, and gaps and directions derived from them, against geometry by hand.

#include "tribound/problem/surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/problem/formula.h"
#include "tribound/problem/formula_calculus.h"

namespace tribound::test
{

namespace
{

using problem::ContactGeometry;
using problem::Positive;
using problem::Surface;
using testing::HasSubstr;

double value(const std::string& text, const std::vector<double>& x)
{
  return problem::Formula(text, {})(x);
}

/// The formulas of a surface are consistent: phi is 0 at the nearest point, which lies at the distance |phi|
/// along grad phi.
void expect_consistent(const Surface& surface, int dim)
{
  std::mt19937 dice(5);
  std::uniform_real_distribution<double> within(-2, 2);
  for (int trial = 0; trial < 50; ++trial)
  {
    std::vector<double> x;
    for (int i = 0; i < dim; ++i) x.push_back(within(dice));
    const double phi = value(surface.distance, x);
    std::vector<double> nearest;
    double length = 0;
    for (int i = 0; i < dim; ++i)
    {
      const double n = value(surface.normal[i], x);
      length += n * n;
      nearest.push_back(value(surface.closest[i], x));
      EXPECT_NEAR(nearest[i], x[i] - phi * n, 1e-12);
    }
    EXPECT_NEAR(length, 1, 1e-12);
    EXPECT_NEAR(value(surface.distance, nearest), 0, 1e-12);
    for (int i = 0; i < dim; ++i)
    {
      std::vector<double> ahead = x;
      std::vector<double> behind = x;
      constexpr double step = 1e-6;
      ahead[i] += step;
      behind[i] -= step;
      EXPECT_NEAR((value(surface.distance, ahead) - value(surface.distance, behind)) / (2 * step),
                  value(surface.normal[i], x), 1e-6);
    }
  }
}

const std::vector<double> centre = {0.3, -0.2, 0.1};

TEST(Surface, FormulasFitTogether)
{
  for (const int dim : {2, 3})
  {
    const std::span<const double> c = std::span(centre).first(dim);
    const std::vector<double> normal = {3, -4, 1};
    expect_consistent(problem::plane(c, std::span(normal).first(dim)), dim);
    for (const Positive side : {Positive::outside, Positive::inside})
    {
      const Surface sphere = problem::sphere(c, 0.7, side);
      expect_consistent(sphere, dim);
      const std::vector<double> by = {0.5, 0.25, -1};
      expect_consistent(problem::moved(sphere, std::span(by).first(dim), {}), dim);
    }
  }
  expect_consistent(problem::cylinder(centre, std::vector<double>{1, 2, 2}, 0.7, Positive::inside), 3);
}

TEST(Surface, SignsSayWhereTheBodyIs)
{
  const std::vector<double> origin = {0, 0};
  EXPECT_EQ(value(problem::sphere(origin, 1, Positive::outside).distance, {3, 0}), 2);
  EXPECT_EQ(value(problem::sphere(origin, 1, Positive::inside).distance, {0.25, 0}), 0.75);
  EXPECT_EQ(value(problem::plane(origin, std::vector<double>{0, 2}).distance, {5, 3}), 3);
  const std::vector<double> x_axis = {1, 0, 0};
  const Surface cylinder = problem::cylinder(std::vector<double>{0, 0, 0}, x_axis, 1, Positive::outside);
  EXPECT_NEAR(value(cylinder.distance, {7, 3, 4}), 4, 1e-14);
  EXPECT_EQ(value(cylinder.normal[0], {7, 3, 4}), 0);
}

/// An implicit function that is not a distance is one to first order.
TEST(Surface, ImplicitSurfacesAreDividedByTheirGradient)
{
  const Surface circle = problem::implicit("x^2 + y^2 - 4", 2, {});
  EXPECT_NEAR(value(circle.normal[0], {0, 2}), 0, 1e-15);
  EXPECT_NEAR(value(circle.normal[1], {0, 2}), 1, 1e-15);
  EXPECT_NEAR(value(circle.distance, {0, 2.001}), 0.001, 1e-6);
  const Surface exact = problem::implicit("sqrt(x^2 + (y + 1)^2) - 1", 2, {});
  EXPECT_NEAR(value(exact.distance, {3, 3}), 4, 1e-14);
  EXPECT_TRUE(exact.closest.empty());
}

TEST(Surface, DirectionsPointToTheObstacle)
{
  const std::vector<double> origin = {0, 0};
  ContactGeometry geometry{.obstacle = problem::plane(origin, std::vector<double>{0, 1})};
  EXPECT_EQ(problem::direction_of_obstacle(geometry)(Point<2>(3, 4)), Point<2>(0, -1));
  EXPECT_TRUE(problem::direction_of_obstacle(geometry).is_constant());
  EXPECT_EQ(problem::gap_of(geometry).degree(), 1);
  // A hole of radius 2 around (0, 3): the facet's point is moved to the circle first.
  const std::vector<double> above = {0, 3};
  geometry.shape = problem::sphere(above, 2, Positive::inside);
  EXPECT_NEAR(problem::gap_of(geometry)(Point<2>(0.6, 1.2)), 3 - 2 * 1.8 / std::hypot(0.6, 1.8), 1e-14);
  const Point<2> out = problem::direction_of_shape(geometry)(Point<2>(0.6, 1.2));
  EXPECT_NEAR((out - Point<2>(-0.6, 1.8).normalized()).norm(), 0, 1e-14);
}

TEST(Surface, DirectionsHaveLengthOne)
{
  const std::vector<std::string> components = {"1", "x"};
  const problem::NormalField along = problem::direction_along(components, {});
  EXPECT_NEAR(along(Point<2>(2, 0))[1], 2 / std::sqrt(5.0), 1e-15);
  const problem::NormalField wrong({problem::Field("x", {.file = {}, .key = "n"}), problem::Field(1.0)});
  EXPECT_THAT(message_of([&] { (void)wrong(Point<2>(0.5, 0)); }),
              HasSubstr("n: the direction of contact has the length 1.11803399 at the point (0.5, 0)"));
  const std::vector<double> origin = {0, 0};
  const ContactGeometry geometry{.obstacle = problem::sphere(origin, 1, Positive::outside),
                                 .where = {.file = {}, .key = "contact"}};
  EXPECT_THAT(message_of([&] { (void)problem::direction_of_obstacle(geometry)(Point<2>(0, 0)); }),
              HasSubstr("contact: the direction of contact is undefined (nan) at the point (0, 0)"));
}

TEST(NormalField, ManyPointsAtOnceGiveTheSame)
{
  const std::vector<double> centre = {0, 1, 0};
  const ContactGeometry geometry{.shape = problem::sphere(centre, 1, Positive::outside),
                                 .where = {.file = {}, .key = "contact"}};
  const problem::NormalField direction = problem::direction_of_shape(geometry);
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> within(-0.5, 0.5);
  std::vector<Point<3>> points(70);  // more than are evaluated in one go
  for (Point<3>& x : points)
    for (double& coordinate : x) coordinate = within(dice);
  std::vector<Point<3>> normals(points.size());
  direction.evaluate<3>(points, normals);
  for (std::size_t q = 0; q < points.size(); ++q)
    EXPECT_NEAR((normals[q] - direction(points[q])).norm(), 0, 1e-15);
  points[40] = Point<3>(0, 1, 0);
  EXPECT_THAT(message_of([&] { direction.evaluate<3>(points, normals); }),
              HasSubstr("at the point (0, 1, 0)"));
  const problem::NormalField too_long({problem::Field(2.0), problem::Field(0.0), problem::Field(0.0)});
  EXPECT_THAT(message_of([&] { too_long.evaluate<3>(points, normals); }), HasSubstr("has the length 2 at"));
}

/// Deviations exceed the distance from the best polynomials, found by sampling.
TEST(NormalField, DeviationsAreBounds)
{
  const std::vector<double> origin = {0, 0};
  const ContactGeometry geometry{.obstacle = problem::sphere(origin, 1, Positive::outside)};
  const problem::NormalField field = problem::direction_of_obstacle(geometry);
  for (const double h : {0.5, 0.1, 0.01})
  {
    const std::array<double, 4> ends = {-h / 2, -1, h / 2, -1};
    const problem::NormalDeviation found = problem::deviation(field, ends, 2);
    // From linear functions sin(a) deviates by h^3/200 or more, cos(a) by h^2/16.
    EXPECT_GE(found.linear, h * h / 17);
    EXPECT_LE(found.linear, h * h);
    EXPECT_LE(found.quadratic, h * h * h);
    EXPECT_GE(found.quadratic, h * h * h / 400);
  }
  const problem::NormalField jump(
      {problem::Field("x > 0.1 ? 1 : 0", {}), problem::Field("x > 0.1 ? 0 : 1", {})});
  EXPECT_NEAR(problem::deviation(jump, std::array{0.0, 0.0, 1.0, 0.0}, 2).quadratic, std::sqrt(0.5), 1e-12);
}

/// Every function of the grammar against differences.
TEST(FormulaCalculus, GradientsAreDerivatives)
{
  const std::vector<std::string> formulas = {"x*y - x/(y + 3) + 2",
                                             "x^2*y^3",
                                             "x^y",
                                             "(x + 1)^2.5",
                                             "sqrt(x + y^2)",
                                             "exp(-x*y)",
                                             "ln(x) + log2(y)",
                                             "log10(x + y)",
                                             "sin(x)*cos(y)",
                                             "tan(x*y/3)",
                                             "asin(x/3) + acos(y/3)",
                                             "atan(x*y)",
                                             "atan2(x, y)",
                                             "sinh(x)*cosh(y)",
                                             "tanh(x - y)",
                                             "asinh(x*y)",
                                             "acosh(x + 2)",
                                             "atanh(y/4)",
                                             "abs(x - 2*y)*x",
                                             "min(x, y^2)",
                                             "max(x*x, y, 3*x - y)",
                                             "x > y ? x*y : -y",
                                             "avg(x, y^2)",
                                             "sum(x, y, x*y)",
                                             "sign(x)*y + rint(x)",
                                             "x < y && y > 0 ? y : x"};
  constexpr double step = 1e-6;
  const std::vector<double> at = {0.7, 1.1};
  for (const std::string& text : formulas)
  {
    const std::vector<std::string> derivatives = problem::gradient(text, 2, {});
    for (std::size_t i = 0; i < 2; ++i)
    {
      std::vector<double> ahead = at;
      std::vector<double> behind = at;
      ahead[i] += step;
      behind[i] -= step;
      EXPECT_NEAR(value(derivatives[i], at), (value(text, ahead) - value(text, behind)) / (2 * step), 1e-7)
          << text << ", " << derivatives[i];
    }
    const std::vector<std::string> shifted = {"(x-0.25)", "(y*2)"};
    EXPECT_NEAR(value(problem::composed(text, shifted, {}), {0.95, 0.55}), value(text, at), 1e-12) << text;
  }
}

}  // namespace

}  // namespace tribound::test
