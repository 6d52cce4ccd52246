/// @file control_point_test.cpp
/// Moved control points: what is wanted where it can be had, and the nearest or best admissible point.

#include "tribound/certify/energy/control_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/dimensions.h"
#include "tribound/base/dense_factors.h"

namespace tribound::test
{

namespace
{

template <class T>
class ControlPoint : public ::testing::Test
{
 protected:
  static constexpr int dim = T::value;
  using Conditions = std::vector<certify::ControlCondition<dim>>;

  double number(double lower, double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(random);
  }
  Point<dim> vector()
  {
    return Point<dim>::NullaryExpr([&] { return number(-1, 1); });
  }
  std::array<bool, dim> any_axes(int n_fixed)
  {
    std::array<bool, dim> fixed{};
    for (int i = 0; i < n_fixed; ++i) fixed[i] = true;
    std::ranges::shuffle(fixed, random);
    return fixed;
  }
  Conditions conditions(int n)
  {
    Conditions result;
    for (int i = 0; i < n; ++i)
      result.push_back({.normal = vector().normalized(),
                        .gap = number(0, 0.3),
                        .closed = random() % 2 == 0,
                        .sticks = random() % 4 == 0,
                        .pressure = number(0.1, 1),
                        .friction = number(0.1, 1)});
    return result;
  }
  static double excess(const Point<dim>& c, const Conditions& conditions)
  {
    double largest = -HUGE_VAL;
    for (const auto& condition : conditions)
      largest = std::max(largest, condition.normal.dot(c) - condition.gap);
    return largest;
  }
  /// How far c is from what is wanted.
  static double missing(const Point<dim>& c, const Conditions& conditions)
  {
    double largest = 0;
    for (const auto& condition : conditions)
    {
      const double along = condition.normal.dot(c);
      if (condition.closed) largest = std::max(largest, std::abs(along - condition.gap));
      if (condition.sticks) largest = std::max(largest, (c - along * condition.normal).norm());
    }
    return largest;
  }

  /// A basis of what leaves fixed components and wanted equalities as they are.
  static Eigen::MatrixXd free_directions(const std::array<bool, dim>& fixed, const Conditions& conditions)
  {
    Tensor<dim> rows = Tensor<dim>::Zero();
    for (int a = 0; a < dim; ++a) rows(a, a) = fixed[a] ? 1 : 0;
    for (const auto& [normal, gap, closed, sticks, pressure, friction] : conditions)
    {
      const Tensor<dim> along = normal * normal.transpose();
      if (closed) rows += along;
      if (sticks) rows += Tensor<dim>::Identity() - along;
    }
    const SymmetricEigen eigen = symmetric_eigen(rows);  // all of rows is semidefinite
    return eigen.vectors.leftCols((eigen.values.array() < 1e-12).count());
  }

  std::mt19937 random{11};
};
TYPED_TEST_SUITE(ControlPoint, Dimensions);

TYPED_TEST(ControlPoint, OfOneFacet)
{
  constexpr int dim = TestFixture::dim;
  for (int round = 0; round < 200; ++round)
  {
    const auto conditions = this->conditions(1);
    const auto& [normal, gap, closed, sticks, pressure, friction] = conditions[0];
    const Point<dim> c = this->vector();
    const Point<dim> x = certify::moved<dim>(c, {}, conditions);
    const double along = normal.dot(c);
    EXPECT_NEAR(normal.dot(x), closed ? gap : std::min(gap, along), 1e-15);
    const Point<dim> tangential = sticks ? Point<dim>::Zero() : Point<dim>(c - along * normal);
    EXPECT_LE((x - normal.dot(x) * normal - tangential).norm(), 1e-15);
    if (!closed && !sticks && along <= gap)
    {
      EXPECT_EQ(x, c);
    }
  }
}

/// No feasible point near the result does better, in the sense that applies.
TYPED_TEST(ControlPoint, OfSeveralFacetsIsTheBest)
{
  constexpr int dim = TestFixture::dim;
  int n_wanted = 0;
  int n_compromises = 0;
  for (int round = 0; round < 600; ++round)
  {
    SCOPED_TRACE(round);
    const auto fixed = this->any_axes(round % dim);
    auto conditions = this->conditions(1 + round % 4);
    Point<dim> c = 0.3 * this->vector();
    for (int a = 0; a < dim; ++a)
      if (fixed[a]) c[a] *= 0.1;
    const Point<dim> x = certify::moved<dim>(c, fixed, conditions);
    for (int a = 0; a < dim; ++a)
      if (fixed[a])
      {
        EXPECT_EQ(x[a], c[a]);
      }
    if (this->excess(x, conditions) > 1e-14)
    {
      EXPECT_EQ(x, c);  // there is none; a search finds none, either
      for (int trial = 0; trial < 2000; ++trial)
      {
        Point<dim> y = c;
        for (int a = 0; a < dim; ++a)
          if (!fixed[a]) y[a] = this->number(-3, 3);
        EXPECT_GT(this->excess(y, conditions), -1e-14);
      }
      continue;
    }
    const bool is_wanted = this->missing(x, conditions) <= 1e-13;
    double total = 0;
    const auto cost = [&](const Point<dim>& y)
    {
      double sum = 0;
      for (const auto& condition : conditions)
      {
        const double along = condition.normal.dot(y);
        if (condition.closed) sum += condition.pressure * std::pow(along - condition.gap, 2);
        if (condition.sticks) sum += condition.friction * (y - along * condition.normal).squaredNorm();
      }
      return sum + 1e-6 * total * (y - c).squaredNorm();
    };
    for (const auto& condition : conditions)
      for (int a = 0; a < dim; ++a)
        if (!fixed[a])
        {
          const Point<dim> axis = Point<dim>::Unit(a);
          const double along = condition.normal.dot(axis);
          if (condition.closed) total += condition.pressure * along * along;
          if (condition.sticks) total += condition.friction * (axis - along * condition.normal).squaredNorm();
        }
    ++(is_wanted ? n_wanted : n_compromises);
    const Eigen::MatrixXd along =
        is_wanted ? this->free_directions(fixed, conditions) : this->free_directions(fixed, {});
    for (const double step : {1e-1, 1e-3, 1e-5})
      for (int trial = 0; trial < 300; ++trial)
      {
        const Point<dim> y = x + step * along * along.transpose() * this->vector();
        if (this->excess(y, conditions) > 0) continue;
        if (is_wanted)
          EXPECT_GE((y - c).norm(), (x - c).norm() - 1e-14);
        else
          EXPECT_GE(cost(y), cost(x) * (1 - 1e-9) - 1e-16);
      }
  }
  EXPECT_GT(n_wanted, 100);
  EXPECT_GT(n_compromises, 50);
}

/// Facets in another order, and all numbers different in their last bits.
TYPED_TEST(ControlPoint, DoesNotDependOnRounding)
{
  constexpr int dim = TestFixture::dim;
  for (int round = 0; round < 2000; ++round)
  {
    SCOPED_TRACE(round);
    auto conditions = this->conditions(2 + round % 5);
    const bool are_alike = round % 2 == 0;  // as along a bent side
    for (auto& condition : conditions)
      if (are_alike)
      {
        condition.normal = (conditions[0].normal + 0.1 * condition.normal).normalized();
        condition.gap = 0.01;
      }
    const Point<dim> c = 0.05 * this->vector();
    const auto fixed = this->any_axes(round % 4 == 3 ? 1 : 0);
    const Point<dim> x = certify::moved<dim>(c, fixed, conditions);
    std::ranges::shuffle(conditions, this->random);
    for (auto& condition : conditions) condition.normal += 2e-16 * this->vector();
    const Point<dim> y = certify::moved<dim>(c + 1e-17 * this->vector(), fixed, conditions);
    EXPECT_LE((x - y).norm(), 1e-6);  // planes that are nearly parallel magnify rounding
  }
}

TYPED_TEST(ControlPoint, InACornerMeetsBothFacets)
{
  constexpr int dim = TestFixture::dim;
  const Point<dim> one = Point<dim>::Unit(0);
  const Point<dim> other = Point<dim>::Unit(dim - 1);
  const std::vector<certify::ControlCondition<dim>> conditions = {
      {.normal = one, .gap = 0.1, .closed = true, .pressure = 1},
      {.normal = (one + other).normalized(), .gap = 0.5, .closed = true, .pressure = 2}};
  const Point<dim> c = Point<dim>::Constant(-0.2);
  const Point<dim> x = certify::moved<dim>(c, {}, conditions);
  EXPECT_NEAR(x[0], 0.1, 1e-15);
  EXPECT_NEAR(x[dim - 1], 0.5 * std::sqrt(2) - 0.1, 1e-15);
  EXPECT_EQ(x[1], dim == 3 ? -0.2 : x[1]);
}

}  // namespace

}  // namespace tribound::test
