/// @file normal_field_terms_test.cpp
/// cnt and frc for a varying direction of contact, against integrals by hand.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/fem/polynomials.h"
#include "verification/arched_block.h"

namespace tribound::test
{

namespace
{

/// cnt^2 + frc^2 of a facet by a rule with many points, from the form's own states at single points. This
/// code shares neither rule nor enclosures with the certificate.
template <int dim>
double squares_by_hand(const DiscreteProblem<dim>& c, std::size_t k, std::span<const double> u,
                       std::span<const Point<dim>> traction, int n_parts)
{
  static_assert(dim == 2);
  const contact::ContactSegment<dim>& segment = c.form.segments()[k];
  const fem::Quadrature<1>& reference = c.form.facet_rule();
  const int p = c.space.degree();
  const int n = p + 1;
  std::vector<Point<dim>> coefficients(n, Point<dim>::Zero());
  std::vector<double> theta(n);
  for (int q = 0; q < reference.size(); ++q)
  {
    fem::orthonormal_values<1>(p, reference.points[q], theta);
    for (int i = 0; i < n; ++i)
      coefficients[i] += reference.weights[q] * theta[i] * traction[k * reference.size() + q];
  }
  double sum = 0;
  for (int part = 0; part < n_parts; ++part)
  {
    std::vector<Point<1>> points;
    for (const Point<1>& s : reference.points) points.emplace_back((part + s[0]) / n_parts);
    const contact::SegmentTables<dim> tables(c.space.basis(), std::span(&segment, 1), points);
    const auto states = c.form.contact_states(u, k, tables[0], contact::WhichData::given);
    for (int q = 0; q < reference.size(); ++q)
    {
      Point<dim> difference = states[q].traction;
      fem::orthonormal_values<1>(p, points[q], theta);
      for (int i = 0; i < n; ++i) difference -= theta[i] * coefficients[i];
      sum += reference.weights[q] / n_parts * difference.squaredNorm();
    }
  }
  return segment.h * segment.measure * sum;
}

/// Checks that the certified contact terms of all facets are not below the actual ones, and hardly above.
void expect_terms(const DiscreteProblem<2>& c, std::span<const double> u, double more, int n_parts)
{
  const std::vector<Point<2>> traction = c.form.traction(u);
  const certify::Stress<2>::Tractions t{
      traction, std::vector<Point<2>>(traction.size(), Point<2>::Zero()), {}};
  const certify::ContactTerms<2> terms(c.form, certify::ContactRule::resolved);
  double certified = 0;
  double by_hand = 0;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const certify::ContactSquares squares = terms(static_cast<int>(k), u, t);
    certified += squares.cnt + squares.frc;
    by_hand += squares_by_hand<2>(c, k, u, traction, n_parts);
  }
  EXPECT_GE(std::sqrt(certified), std::sqrt(by_hand) * (1 - 1e-5));
  EXPECT_LE(std::sqrt(certified), std::sqrt(by_hand) * more);
}

TEST(NormalField, TheContactTermsAreWhatTheyAreByHand)
{
  for (const int p : {1, 2, 3})
    for (const auto& [name, surface] : obstacles(2))
      for (const problem::ContactLaw& law : laws())
      {
        const DiscreteProblem<2> c(arched_block<2>(4), pressed_on<2>(contact_with(surface, law, 2)),
                                   {.degree = p});
        SCOPED_TRACE(fmt::format("{}, p = {}, {}", name, p, problem::name(law)));
        expect_terms(c, c.solve().u, 1.05, 400);
      }
}

/// A direction that deviates between the points of the rule, on so small a part of the facet that no point
/// sees it.
TEST(NormalField, WhatHappensBetweenThePointsIsSeen)
{
  const std::string angle = "(0.4*exp(-((x-0.1234)/0.0004)^2))";
  problem::Contact contact(Coulomb(0.3), 0.0);
  contact.normal = problem::NormalField({formula("sin" + angle), formula("-cos" + angle)});
  const DiscreteProblem<2> c(arched_block<2>(4), pressed_on<2>(contact), {.degree = 2});
  for (const contact::ContactPoint<2>& point : c.form.contact_points())
    ASSERT_LE(std::abs(point.normal[0]), 1e-6);
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 1; i < u.size(); i += 2) u[i] = -0.01;
  expect_terms(c, u, 1.2, 4000);
}

/// The certificate must take N where the form took it: a shift by half a facet is seen by hand. (Where
/// contact sticks, T hardly depends on N.)
TEST(NormalField, ADirectionAtAnotherPointIsSeen)
{
  const auto [name, surface] = obstacles(2)[1];
  const problem::Contact right = contact_with(surface, Frictionless(), 2);
  const DiscreteProblem<2> c(arched_block<2>(4), pressed_on<2>(right), {.degree = 2});
  problem::Contact wrong = right;
  wrong.normal = contact_with(problem::moved(surface, point({0.125, 0}, 2), {}), Frictionless(), 2).normal;
  const DiscreteProblem<2> aside(arched_block<2>(4), pressed_on<2>(wrong), {.degree = 2});
  const std::vector<double> u = c.solve().u;
  const std::vector<Point<2>> traction = c.form.traction(u);
  const certify::Stress<2>::Tractions t{
      traction, std::vector<Point<2>>(traction.size(), Point<2>::Zero()), {}};
  double mutated = 0;
  double by_hand = 0;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const certify::ContactSquares squares =
        certify::ContactTerms<2>(aside.form, certify::ContactRule::resolved)(static_cast<int>(k), u, t);
    mutated += squares.cnt + squares.frc;
    by_hand += squares_by_hand<2>(c, k, u, traction, 400);
  }
  EXPECT_GT(std::abs(std::sqrt(mutated) - std::sqrt(by_hand)), 0.2 * std::sqrt(by_hand));
}

}  // namespace

}  // namespace tribound::test
