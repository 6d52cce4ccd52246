/// @file projection_test.cpp
/// The two projections: closed values, variational property, derivatives against differences.

#include "contact/projection.h"

#include <gtest/gtest.h>

#include <vector>

namespace tribound::test
{

namespace
{

TEST(NegativePart, ValuesAndDerivative)
{
  EXPECT_EQ(negative_part(-2.5), -2.5);
  EXPECT_EQ(negative_part(0), 0);
  EXPECT_EQ(negative_part(3), 0);
  EXPECT_EQ(negative_part_derivative(-2.5), 1);
  EXPECT_EQ(negative_part_derivative(0), 1);
  EXPECT_EQ(negative_part_derivative(3), 0);
}

TEST(BallProjection, KeepsTheInsideAndPullsTheRestToTheSphere)
{
  EXPECT_EQ(ball_projection<2>({0.3, -0.4}, 0.5), Point<2>(0.3, -0.4));
  EXPECT_LE((ball_projection<2>({3, -4}, 2.5) - Point<2>(1.5, -2)).norm(), 1e-15);
  EXPECT_LE((ball_projection<3>({2, 4, 4}, 3) - Point<3>(1, 2, 2)).norm(), 1e-15);
}

/// (x - [x]_a).(y - [x]_a) <= 0 for all y of the ball.
TEST(BallProjection, IsTheNearestPointOfTheBall)
{
  const Point<3> x(0.7, -1.1, 0.2);
  const Point<3> projection = ball_projection<3>(x, 0.8);
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
    const Tensor<dim> derivative = ball_projection_derivative<dim>(x, a);
    for (int j = 0; j < dim; ++j)
    {
      const Point<dim> step = h * Point<dim>::Unit(j);
      const Point<dim> difference =
          (ball_projection<dim>(x + step, a) - ball_projection<dim>(x - step, a)) / (2 * h);
      EXPECT_LE((difference - derivative.col(j)).norm(), 1e-9);
    }
    const Point<dim> by_radius = (ball_projection<dim>(x, a + h) - ball_projection<dim>(x, a - h)) / (2 * h);
    EXPECT_LE((by_radius - ball_projection_radius_derivative<dim>(x, a)).norm(), 1e-9);
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
  EXPECT_EQ(ball_projection<3>(x, 0), zero);
  EXPECT_EQ(ball_projection<3>(zero, 0), zero);
  EXPECT_EQ(ball_projection_derivative<3>(x, 0), Tensor<3>::Zero());
  EXPECT_EQ(ball_projection_derivative<3>(zero, 0), Tensor<3>::Zero());
  EXPECT_EQ(ball_projection_radius_derivative<3>(zero, 0), zero);
  EXPECT_LE((ball_projection_radius_derivative<3>(x, 0) - x.normalized()).norm(), 1e-15);
}

}  // namespace

}  // namespace tribound::test
