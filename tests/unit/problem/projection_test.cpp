/// @file projection_test.cpp
/// The two projections: closed-form values, variational property, derivatives against differences.

#include "tribound/problem/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tribound::test
{

namespace
{

TEST(NegativePart, ValuesAndDerivative)
{
  EXPECT_EQ(problem::negative_part(-2.5), -2.5);
  EXPECT_EQ(problem::negative_part(0), 0);
  EXPECT_EQ(problem::negative_part(3), 0);
  EXPECT_EQ(problem::negative_part_derivative(-2.5), 1);
  EXPECT_EQ(problem::negative_part_derivative(0), 1);
  EXPECT_EQ(problem::negative_part_derivative(3), 0);
}

TEST(BallProjection, KeepsTheInsideAndPullsTheRestToTheSphere)
{
  EXPECT_EQ(problem::ball_projection<2>({0.3, -0.4}, 0.5), Point<2>(0.3, -0.4));
  EXPECT_LE((problem::ball_projection<2>({3, -4}, 2.5) - Point<2>(1.5, -2)).norm(), 1e-15);
  EXPECT_LE((problem::ball_projection<3>({2, 4, 4}, 3) - Point<3>(1, 2, 2)).norm(), 1e-15);
}

/// (x - [x]_a).(y - [x]_a) <= 0 for all y of the ball.
TEST(BallProjection, IsTheNearestPointOfTheBall)
{
  const Point<3> x(0.7, -1.1, 0.2);
  const Point<3> projection = problem::ball_projection<3>(x, 0.8);
  for (int i = 0; i < 200; ++i)
  {
    const Point<3> y = 0.8 * Point<3>(std::sin(i), std::cos(3 * i + 1), std::sin(7 * i + 2)).normalized();
    EXPECT_LE((x - projection).dot(y - projection), 1e-15);
  }
}

/// Points inside and outside the ball of radius a.
template <int dim>
std::vector<Point<dim>> samples(double a)
{
  std::vector<Point<dim>> points;
  for (const double length : {0.1, 0.9, 1.1, 4.0})
    for (int i = 0; i < 5; ++i)
      points.push_back(a * length *
                       (Point<dim>::Constant(0.3) + Point<dim>::LinSpaced(i, 2 - i)).normalized());
  return points;
}

template <int dim>
void expect_derivatives_agree_with_differences()
{
  constexpr double a = 0.7;
  constexpr double h = 1e-6;
  for (const Point<dim>& x : samples<dim>(a))
  {
    const Tensor<dim> derivative = problem::ball_projection_derivative<dim>(x, a);
    for (int j = 0; j < dim; ++j)
    {
      const Point<dim> step = h * Point<dim>::Unit(j);
      const Point<dim> difference =
          (problem::ball_projection<dim>(x + step, a) - problem::ball_projection<dim>(x - step, a)) / (2 * h);
      EXPECT_LE((difference - derivative.col(j)).norm(), 1e-9);
    }
    const Point<dim> by_radius =
        (problem::ball_projection<dim>(x, a + h) - problem::ball_projection<dim>(x, a - h)) / (2 * h);
    EXPECT_LE((by_radius - problem::ball_projection_radius_derivative<dim>(x, a)).norm(), 1e-9);
  }
}

TEST(BallProjection, DerivativesAgreeWithDifferences)
{
  expect_derivatives_agree_with_differences<2>();
  expect_derivatives_agree_with_differences<3>();
}

TEST(BallProjection, RadiusZero)
{
  const Point<3> x(1, 2, 3);
  const Point<3> zero = Point<3>::Zero();
  EXPECT_EQ(problem::ball_projection<3>(x, 0), zero);
  EXPECT_EQ(problem::ball_projection<3>(zero, 0), zero);
  EXPECT_EQ(problem::ball_projection_derivative<3>(x, 0), Tensor<3>::Zero());
  EXPECT_EQ(problem::ball_projection_derivative<3>(zero, 0), Tensor<3>::Zero());
  EXPECT_EQ(problem::ball_projection_radius_derivative<3>(zero, 0), zero);
  EXPECT_LE((problem::ball_projection_radius_derivative<3>(x, 0) - x.normalized()).norm(), 1e-15);
}

/// The mean of f over (x - delta, x + delta), by the midpoint rule.
template <class F>
double mean(const F& f, double x, double delta)
{
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(x + delta * ((2 * i + 1.0) / n - 1));
  return sum / n;
}

TEST(RegularisedNegativePart, IsTheFormulaOfTheMethod)
{
  constexpr double delta = 0.5;
  EXPECT_EQ(problem::negative_part(-0.5, delta), -0.5);
  EXPECT_EQ(problem::negative_part(-2, delta), -2);
  EXPECT_EQ(problem::negative_part(0.5, delta), 0);
  EXPECT_EQ(problem::negative_part(2, delta), 0);
  EXPECT_DOUBLE_EQ(problem::negative_part(0, delta), -delta / 4);
  EXPECT_DOUBLE_EQ(problem::negative_part(0.2, delta), -0.09 / 2);
  for (const double x : {-0.6, -0.4, -0.1, 0.0, 0.3, 0.49})
    EXPECT_NEAR(problem::negative_part(x, delta),
                mean([](double y) { return problem::negative_part(y); }, x, delta), 1e-8);
}

TEST(RegularisedNegativePart, IsDifferentiableEverywhere)
{
  constexpr double delta = 0.5;
  constexpr double h = 1e-6;
  for (const double x : {-1.0, -0.5, -0.3, 0.0, 0.2, 0.5, 0.7})
  {
    const double difference =
        (problem::negative_part(x + h, delta) - problem::negative_part(x - h, delta)) / (2 * h);
    EXPECT_NEAR(difference, problem::negative_part_derivative(x, delta), 2e-6) << x;
  }
}

/// Both sides of every kink, and the kinks themselves.
constexpr std::array lengths{0.0, 0.05, 0.2, 0.3, 0.5, 0.7, 0.9, 1.2, 3.0};
constexpr std::array deltas{0.2, 0.7, 1.5};  ///< below, at and above the radius 0.7

TEST(RegularisedBallProjection, IsTheMeanOfTheProjectionOnTheLine)
{
  static constexpr double a = 0.7;
  for (const double delta : deltas)
    for (const double r : lengths)
    {
      const double expected = mean([](double y) { return std::clamp(y, -a, a); }, r, delta);
      EXPECT_NEAR(problem::ball_projection<2>({0, r}, a, delta)[1], expected, 1e-8) << r << " " << delta;
      EXPECT_NEAR(problem::ball_projection<2>({0, -r}, a, delta)[1], -expected, 1e-8) << r << " " << delta;
    }
}

TEST(RegularisedBallProjection, StaysInTheBallAndTendsToTheProjection)
{
  static constexpr double a = 0.7;
  const Point<3> direction = Point<3>(1, -2, 2) / 3;
  for (const double r : lengths)
  {
    const Point<3> x = r * direction;
    for (const double delta : deltas) EXPECT_LE(problem::ball_projection<3>(x, a, delta).norm(), a + 1e-15);
    for (const double delta : {1e-2, 1e-4, 1e-8})
      EXPECT_LE((problem::ball_projection<3>(x, a, delta) - problem::ball_projection<3>(x, a)).norm(),
                delta / 4 + 1e-15);
    EXPECT_EQ(problem::ball_projection<3>(x, 0, 0.2), Point<3>(Point<3>::Zero()));
    EXPECT_EQ(problem::ball_projection_derivative<3>(x, 0, 0.2), Tensor<3>(Tensor<3>::Zero()));
  }
}

template <int dim>
void expect_regularised_derivatives_agree_with_differences()
{
  static constexpr double a = 0.7;
  constexpr double h = 1e-6;
  const Point<dim> direction = (Point<dim>::Constant(0.3) + Point<dim>::LinSpaced(-1, 2)).normalized();
  for (const double delta : deltas)
    for (const double r : lengths)
    {
      const Point<dim> x = r * direction;
      const Tensor<dim> derivative = problem::ball_projection_derivative<dim>(x, a, delta);
      for (int j = 0; j < dim; ++j)
      {
        const Point<dim> step = h * Point<dim>::Unit(j);
        const Point<dim> difference = (problem::ball_projection<dim>(x + step, a, delta) -
                                       problem::ball_projection<dim>(x - step, a, delta)) /
                                      (2 * h);
        EXPECT_LE((difference - derivative.col(j)).norm(), 5e-6) << r << " " << delta;
      }
      const Point<dim> by_radius =
          (problem::ball_projection<dim>(x, a + h, delta) - problem::ball_projection<dim>(x, a - h, delta)) /
          (2 * h);
      EXPECT_LE((by_radius - problem::ball_projection_radius_derivative<dim>(x, a, delta)).norm(), 5e-6)
          << r << " " << delta;
    }
}

TEST(RegularisedBallProjection, IsDifferentiableEverywhere)
{
  expect_regularised_derivatives_agree_with_differences<2>();
  expect_regularised_derivatives_agree_with_differences<3>();
}

}  // namespace

}  // namespace tribound::test
