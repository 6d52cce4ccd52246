/// @file contact_terms_test.cpp
/// The norms on the contact boundary against integrals done by hand, across kinks of the traction.

#include "tribound/certify/bound/contact_terms.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/polynomials.h"

namespace tribound::test
{

namespace
{

/// A unit block on a floor with one contact facet per cell side, E and nu such that lambda = 0, mu = 1/2.
template <int dim>
DiscreteProblem<dim> unit_block(int p, const problem::Field& gap,
                                const problem::ContactLaw& law = Frictionless())
{
  std::array<int, dim> one_cell;
  one_cell.fill(1);
  return {box<dim>(Point<dim>::Zero(), Point<dim>::Ones(), one_cell),
          {.boundaries = {clamped<dim>("top"), obstacle<dim>("bottom", law, gap)}, .material = lame(1, 0)},
          {.degree = p, .gamma0 = 1}};
}

template <int dim>
using Tractions = typename certify::Stress<dim>::Tractions;

/// The same traction everywhere in the place of T(u), by default none: what is left of cnt and frc is the
/// norm of T(u).
template <int dim>
Tractions<dim> constant_traction(const DiscreteProblem<dim>& c, const Point<dim>& t = Point<dim>::Zero())
{
  return {std::vector<Point<dim>>(c.form.n_contact_points(), t),
          std::vector<Point<dim>>(c.form.n_contact_points(), Point<dim>::Zero()),
          {}};
}

template <int dim>
certify::ContactSquares sum_over_facets(const DiscreteProblem<dim>& c, const std::vector<double>& u,
                                        certify::ContactRule rule)
{
  const Tractions<dim> none = constant_traction(c);
  const certify::ContactTerms<dim> terms(c.form, rule);
  certify::ContactSquares sum;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const certify::ContactSquares squares = terms(static_cast<int>(k), u, none);
    const double h = c.form.segments()[k].h;
    sum.cnt += squares.cnt / h;
    sum.frc += squares.frc / h;
  }
  return sum;
}

/// Without gradient at the floor P = -gamma (u - g n): u = (a(x), b(x)) there, whatever the degree.
TEST(ContactTerms, AKinkOfTheNormalTractionIsResolvedIn2D)
{
  // u = 0, n = -e_y, P^n = gamma g >= 0 unless u^n > g; translate by u = (0, -b): P^n = -gamma (b - g(x)).
  // gamma = gamma_0 (lambda + 2 mu)/h = 1. With g = x and b = 0.3: P^n = x - 0.3, negative part on [0, 0.3].
  for (int p = 1; p <= 4; ++p)
  {
    const DiscreteProblem<2> c = unit_block<2>(p, formula("x"));
    std::vector<double> u(c.space.n_dofs(), 0.0);
    for (std::size_t i = 1; i < u.size(); i += 2) u[i] = -0.3;
    const double exact = std::pow(0.3, 3) / 3;
    EXPECT_NEAR(sum_over_facets(c, u, certify::ContactRule::resolved).cnt, exact, 1e-9 * exact)
        << "p = " << p;
    EXPECT_GT(std::abs(sum_over_facets(c, u, certify::ContactRule::reference).cnt - exact), 1e-6 * exact)
        << "the plain rule cannot be exact across a kink, p = " << p;
  }
}

TEST(ContactTerms, AKinkOfTheFrictionLimitIsResolvedIn2D)
{
  // u = (0.7, 0): P^t = -0.7; threshold s = x: [P^t]_s = -min(x, 0.7).
  const DiscreteProblem<2> c = unit_block<2>(2, 1, Tresca(formula("x")));
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 0; i < u.size(); i += 2) u[i] = 0.7;
  const double exact = std::pow(0.7, 3) / 3 + 0.3 * 0.49;
  EXPECT_NEAR(sum_over_facets(c, u, certify::ContactRule::resolved).frc, exact, 1e-9 * exact);
  EXPECT_EQ(sum_over_facets(c, u, certify::ContactRule::resolved).cnt, 0.0);
}

TEST(ContactTerms, KinksAreResolvedIn3D)
{
  // Facets have the diameter sqrt 2, so gamma = 1/sqrt 2: P^n = gamma (x + z - 0.9), negative in a triangle
  // of legs 0.9: integral of (0.9 - r)^2 with r = x + z over it is int_0^0.9 (0.9 - r)^2 r dr = 0.9^4 / 12.
  const DiscreteProblem<3> c = unit_block<3>(1, formula("x + z"));
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 1; i < u.size(); i += 3) u[i] = -0.9;
  const double exact = 0.5 * std::pow(0.9, 4) / 12;
  EXPECT_NEAR(sum_over_facets(c, u, certify::ContactRule::resolved).cnt, exact, 1e-5 * exact);
  EXPECT_GT(std::abs(sum_over_facets(c, u, certify::ContactRule::reference).cnt - exact), 1e-4 * exact);
}

TEST(ContactTerms, TheDirectionOfSlipIsResolvedIn3D)
{
  // u = (1, 0, 2z - 1), s = 0.3 < gamma |u|: T^t = -s u/|u| turns without a kink. Against a traction (c, 0,
  // 0) the square is s^2 + 2 s c/|u| + c^2, and the integral of 1/(1 + (2z - 1)^2)^{1/2} is asinh 1.
  constexpr double s = 0.3;
  constexpr double c = 0.2;
  const DiscreteProblem<3> block = unit_block<3>(1, 0, Tresca(s));
  const std::vector<double> u =
      interpolate<3>(block.space, [](const Point<3>& x) { return Point<3>(1, 0, 2 * x[2] - 1); });
  const Tractions<3> given = constant_traction(block, Point<3>(c, 0, 0));
  const double exact = s * s + 2 * s * c * std::asinh(1) + c * c;
  const auto frc = [&](certify::ContactRule rule)
  {
    const certify::ContactTerms<3> terms(block.form, rule);
    double sum = 0;
    for (int k = 0; k < 2; ++k) sum += terms(k, u, given).frc / block.form.segments()[k].h;
    return sum;
  };
  EXPECT_NEAR(frc(certify::ContactRule::resolved), exact, 1e-6 * exact);
  EXPECT_GT(std::abs(frc(certify::ContactRule::reference) - exact), 1e-6 * exact);
}

/// Where all slips in one direction T is a polynomial, and what is left of the component is rounding.
TEST(ContactTerms, UniformSlipIn3DLeavesRounding)
{
  constexpr double s = 0.3;
  const DiscreteProblem<3> block = unit_block<3>(1, 0, Tresca(s));
  const Point<3> direction = Point<3>(0.6, 0, 0.8);
  const std::vector<double> u = interpolate<3>(block.space, [&](const Point<3>&) { return direction; });
  const Tractions<3> own = constant_traction<3>(block, -s * direction);
  const certify::ContactTerms<3> terms(block.form, certify::ContactRule::resolved);
  for (int k = 0; k < 2; ++k) EXPECT_LE(terms(k, u, own).frc, 1e-26);
}

TEST(ContactTerms, WithoutAKinkBothRulesAgreeToTheLastBit)
{
  const DiscreteProblem<2> c = unit_block<2>(2, formula("0.1*x"));
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 1; i < u.size(); i += 2) u[i] = -0.9;
  EXPECT_EQ(sum_over_facets(c, u, certify::ContactRule::resolved).cnt,
            sum_over_facets(c, u, certify::ContactRule::reference).cnt);
}

/// P^n = g - u^n is a cubic above half of its range at all points of the rule, and negative near both ends.
TEST(ContactTerms, AKinkBetweenThePointsAndTheEndsIsSeen)
{
  const fem::Quadrature<1> rule = fem::quadrature<1>(fem::data_quadrature_degree(1));
  std::vector<double> x;
  for (const Point<1>& point : rule.points) x.push_back(point[0]);
  std::ranges::sort(x);
  constexpr double u_n = 0.4;  // so that the gap is none that is negative
  std::string text = fmt::format("{}", u_n);
  for (int i = 0; i < 4; ++i)
  {
    text += i % 2 == 0 ? " + 0.6" : " + 1.6";
    for (int j = 0; j < 4; ++j)
      if (j != i) text += fmt::format("*(x - {:.17g})/({:.17g})", x[j], x[i] - x[j]);
  }
  const problem::Field gap = formula(text);
  const DiscreteProblem<2> c = unit_block<2>(1, gap);
  double expected = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i)
    expected += std::pow(std::min(0.0, gap(Point<2>((i + 0.5) / n, 0)) - u_n), 2) / n;
  EXPECT_GT(expected, 1e-4);
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 1; i < u.size(); i += 2) u[i] = -u_n;
  EXPECT_NEAR(sum_over_facets(c, u, certify::ContactRule::resolved).cnt, expected, 1e-6 * expected);
}

/// P^n = g - u^n is zero but for rounding, whose kinks have no end.
TEST(ContactTerms, TheKinksOfRoundingEnd)
{
  for (int p = 1; p <= 4; ++p)
  {
    const DiscreteProblem<2> c = unit_block<2>(p, formula("0.1*x + 0.2*x"));
    std::vector<double> u(c.space.n_dofs(), 0.0);
    const std::vector<Point<2>> nodes = c.space.node_points();
    for (std::size_t i = 0; i < nodes.size(); ++i) u[2 * i + 1] = -0.3 * nodes[i][0];
    // Of terms of P as large as 1.
    constexpr double rounding = 20 * std::numeric_limits<double>::epsilon();
    EXPECT_LT(sum_over_facets(c, u, certify::ContactRule::resolved).cnt, rounding * rounding);
  }
}

/// P^n = g - u^n, positive at all points of the rule on the facets, negative in a small disc between them.
TEST(ContactTerms, ASmallDiscOfContactBetweenThePointsIsSeenIn3D)
{
  for (const double radius : {0.05, 0.02})
    for (const Point<2>& centre : {Point<2>(0.61, 0.29), Point<2>(0.23, 0.7)})
    {
      const DiscreteProblem<3> c =
          unit_block<3>(1, formula(fmt::format("(x - {})^2 + (z - {})^2", centre[0], centre[1])));
      std::vector<double> u(c.space.n_dofs(), 0.0);
      for (std::size_t i = 1; i < u.size(); i += 3) u[i] = -radius * radius;
      // gamma^2 times the integral of (r^2 - radius^2)^2 over the disc.
      const double exact = 0.5 * std::numbers::pi * std::pow(radius, 6) / 3;
      EXPECT_EQ(sum_over_facets(c, u, certify::ContactRule::reference).cnt, 0.0) << "seen by the plain rule";
      EXPECT_NEAR(sum_over_facets(c, u, certify::ContactRule::resolved).cnt, exact, 1e-4 * exact);
    }
}

/// There are kernels up to fem::max_degree; a space of a higher one, as for richer solutions, gets no bound.
TEST(ContactTerms, ADegreeBeyondTheKernelsIsAnError)
{
  const DiscreteProblem<2> c = unit_block<2>(1, 0);
  const fem::LagrangeSpace<2> space(c.mesh, fem::max_degree + 1);
  const contact::NitscheForm<2> form(c.problem, space, 10);
  EXPECT_THROW(certify::ContactTerms<2>(form, certify::ContactRule::resolved), InputError);
  EXPECT_THROW(certify::Equilibrator<2>(form, certify::PatchStress::rows), InputError);
}

}  // namespace

}  // namespace tribound::test
