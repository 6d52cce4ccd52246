/// @file discrete_gap_test.cpp
/// Gaps that the rules do not integrate exactly. There is no spurious contact, and all that is reported of
/// contact comes from one traction.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// A clamped block above an obstacle.
template <int dim>
DiscreteProblem<dim> above(const std::string& gap, int degree)
{
  return {block<dim>({4, 2}, {2, 1, 1}),
          {.boundaries = {clamped<dim>("left"), obstacle<dim>("bottom", Coulomb(0.2), formula(gap))}},
          {.degree = degree}};
}

/// The polynomials with the moments of these gaps are negative near the kink or the jump.
template <int dim>
void expect_no_touch()
{
  for (const std::string gap :
       {"max(0, x-0.61)", "x > 0.3 ? 1 : 0", "x > 0.3 ? 1e6 : 1e-3", "abs(x-0.7)", "0.1*max(0, x-0.61)+1e-4"})
    for (int degree = 1; degree <= 3; ++degree)
    {
      const DiscreteProblem<dim> c = above<dim>(gap, degree);
      const std::vector<double> u(c.space.n_dofs(), 0.0);
      for (const Point<dim>& t : c.form.traction(u)) EXPECT_EQ(t.norm(), 0) << gap << ", degree " << degree;
    }
}

TEST(DiscreteGap, NothingTouchesWhereNothingDoes)
{
  expect_no_touch<2>();
  expect_no_touch<3>();
}

/// Where the gap is limited, its mean remains that of the formula.
TEST(DiscreteGap, HasTheMeanOfTheFormula)
{
  const DiscreteProblem<2> c = above<2>("max(0, x-0.61)", 2);
  double sum = 0;
  for (const contact::ContactPoint<2>& point : c.form.contact_points()) sum += point.weight * point.gap;
  EXPECT_NEAR(sum, (2 - 0.61) * (2 - 0.61) / 2, 1e-3);
}

/// The states that files, pages and warnings show add up to the resultants of the certificate.
template <int dim>
void expect_one_traction(const std::string& gap)
{
  const DiscreteProblem<dim> c = above<dim>(gap, 2);
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 0.01 * std::sin(1.0 + static_cast<double>(i));
  const std::vector<Point<dim>> t = c.form.traction(u);
  const int n = c.form.n_segment_points();
  const std::vector<Point<dim - 1>> points = c.form.facet_rule().points;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = c.form.segments()[k];
    const auto states = c.form.contact_states(u, k);
    const auto table = contact::tabulate<dim>(c.space.basis(), segment.slave, points);
    const auto elsewhere = c.form.contact_states(u, k, {points, &table, nullptr});
    for (int q = 0; q < n; ++q)
    {
      const Point<dim>& expected = t[k * n + q];
      EXPECT_LE((states[q].traction - expected).norm(), 1e-12) << gap;
      EXPECT_LE((elsewhere[q].traction - expected).norm(), 1e-12) << gap;
      EXPECT_EQ(states[q].pressure > 0, expected.norm() > 0) << gap;
    }
  }
}

TEST(DiscreteGap, StatesAreThoseOfTheDiscreteTraction)
{
  for (const std::string gap : {"max(0, x-0.61)-0.01", "x > 0.3 ? 0.02 : -0.02", "0.01*sin(9*x)"})
  {
    expect_one_traction<2>(gap);
    expect_one_traction<3>(gap);
  }
}

}  // namespace

}  // namespace tribound::test
