/// @file balance_test.cpp
/// Loads, reactions and contact forces: their sum vanishes up to rounding at every Newton iterate, and the
/// parts agree with hand calculations.

#include "tribound/certify/bound/balance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{
namespace
{

double largest(const std::vector<double>& values)
{
  double result = 0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

/// The remainder of the sum, relative to the largest force and moment.
struct Defect
{
  double force = 0;
  double moment = 0;
};

Defect defect(const certify::Balance& balance)
{
  double force = 0;
  double moment = 0;
  for (const certify::BalanceRow& row : balance.rows)
  {
    if (row.kind == certify::BalanceKind::sum) continue;
    force = std::max(force, largest(row.force));
    moment = std::max(moment, largest(row.moment));
  }
  const certify::BalanceRow& sum = balance.rows.back();
  return {largest(sum.force) / force, largest(sum.moment) / moment};
}

template <int dim>
certify::Balance balance_of(const DiscreteProblem<dim>& c, const Point<dim>& about)
{
  const solve::NewtonResult<dim> result = c.solve();
  return certify::balance<dim>(c.form, result.u, result.traction, about);
}

const certify::BalanceRow& find(const certify::Balance& balance, certify::BalanceKind kind,
                                const std::string& name)
{
  const auto row = std::ranges::find_if(
      balance.rows, [&](const certify::BalanceRow& r) { return r.kind == kind && r.name == name; });
  EXPECT_NE(row, balance.rows.end()) << name;
  return *row;
}

const problem::Field wavy = formula("0.002*(1 + sin(3*x))");
const std::array contacts = {problem::Contact(Frictionless(), wavy),
                             problem::Contact(Tresca(formula("0.01 + 0.005*sin(x)"))),
                             problem::Contact(Coulomb(0.4), wavy)};

/// Body force, traction, pressure, a clamp inclined to the contact boundary by a roller, contact on one side;
/// nothing vanishes and no datum is a polynomial.
template <int dim>
ProblemData<dim> data(const problem::Contact& contact)
{
  ProblemData<dim> all{
      .boundaries = {obstacle<dim>("bottom", contact), pressed<dim>("top", formula("0.05*exp(x)")),
                     loaded<dim>("right", 0.02, formula("0.01*sin(y)"), 0.005)},
      .body_force =
          components<dim>(formula("0.1*sin(5*x)*exp(y)"), formula("-0.1*exp(x*y)"), formula("0.02*cos(z)"))};
  if (dim == 2)
    all.boundaries.push_back(loaded<dim>(fixed<dim>("left", 0, free), 0, 0.01));
  else
    all.boundaries.insert(all.boundaries.end(),
                          {clamped<dim>("left"), loaded<dim>(fixed<dim>("back", free, free, 0), 0.01, 0)});
  return all;
}

template <int dim>
void every_iterate(int p)
{
  Defect worst;
  const Point<dim> about = Point<dim>::Constant(0.3);
  int iterates = 0;
  for (const problem::Contact& contact : contacts)
  {
    SCOPED_TRACE(words(contact.law));
    const DiscreteProblem<dim> c(block<dim>({4, 2}, {2, 1, 1}), data<dim>(contact),
                                 {.degree = p, .newton = {.tolerance = 1e-12, .damping = false}});
    const auto examine = [&](const solve::NewtonIterate<dim>& iterate)
    {
      const certify::Balance b = certify::balance<dim>(c.form, iterate.u(), iterate.traction, about);
      const Defect d = defect(b);
      ++iterates;
      EXPECT_LE(d.force, 1e-11) << "iterate " << iterates;
      EXPECT_LE(d.moment, 1e-11);
      worst = {std::max(worst.force, d.force), std::max(worst.moment, d.moment)};
      return solve::NewtonAdvice(false);
    };
    (void)c.solve(0, examine);
  }
  EXPECT_GT(iterates, 5) << "too easy to tell iterates apart";
  fmt::print("{}D, p = {}: the sum is {:.1e} of the largest force, {:.1e} of the largest moment\n", dim, p,
             worst.force, worst.moment);
}

class Balance2D : public ::testing::TestWithParam<int>
{
};
TEST_P(Balance2D, EveryIterateOfEveryLaw)
{
  every_iterate<2>(GetParam());
}
INSTANTIATE_TEST_SUITE_P(Degrees, Balance2D, ::testing::Range(1, 5));

class Balance3D : public ::testing::TestWithParam<int>
{
};
TEST_P(Balance3D, EveryIterateOfEveryLaw)
{
  every_iterate<3>(GetParam());
}
INSTANTIATE_TEST_SUITE_P(Degrees, Balance3D, ::testing::Range(1, 5));

/// A cantilever of length 3 and height 2, clamped at the left, under its weight, a triangular pressure on top
/// (3 x / 3 per length) and a shear on the right. By statics the clamp carries the resultants.
class Cantilever : public ::testing::TestWithParam<int>
{
};
TEST_P(Cantilever, ClampCarriesWhatStaticsSays)
{
  const DiscreteProblem<2> c(
      box<2>({0, 0}, {3, 2}, {3, 2}),
      {.boundaries = {clamped<2>("left"), loaded<2>(pressed<2>("top", formula("x")), 0.25, 0),
                      loaded<2>("right", 0, 0.1)},
       .body_force = {0, -0.5}},
      {.degree = GetParam()});
  const certify::Balance b = balance_of<2>(c, {0, 1});
  const auto expect = [&](certify::BalanceKind kind, const std::string& name, const std::string& source,
                          std::vector<double> force, double moment)
  {
    SCOPED_TRACE(name);
    const certify::BalanceRow& row = find(b, kind, name);
    EXPECT_EQ(row.source, source);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(row.force[i], force[i], 1e-11);
    EXPECT_NEAR(row.moment[0], moment, 1e-11);
  };
  expect(certify::BalanceKind::load, "box", "body force", {0, -3}, -3 * 1.5);
  // pressure: 9/2 at x = 2; traction: 3/4 at height 1 above the point
  expect(certify::BalanceKind::load, "top", "traction and pressure", {0.75, -4.5}, -4.5 * 2 - 0.75);
  expect(certify::BalanceKind::load, "right", "traction", {0, 0.2}, 0.2 * 3);
  expect(certify::BalanceKind::reaction, "left", "displacement", {-0.75, 7.3}, 4.5 + 9 + 0.75 - 0.6);
  EXPECT_EQ(b.rows.size(), 5u);
}
INSTANTIATE_TEST_SUITE_P(Degrees, Cantilever, ::testing::Range(1, 3));

/// Supports that meet share the force of their common node by the measures of their facets there, here in
/// halves. Under a constant stress, Simpson's rule (p = 2) and the trapezoidal rule (p = 1) give the forces
/// of nodes.
TEST(Balance, SupportsThatMeetShareTheForceOfTheirNode)
{
  const problem::Field u = formula("0.1*x");
  for (int p = 1; p <= 2; ++p)
  {
    const double normal = (1 + 2) * 0.1;  // sigma_xx
    const double lateral = 0.1;           // sigma_yy
    const DiscreteProblem<2> c(block<2>({4, 2}),
                               {.boundaries = {fixed<2>("left", u, 0), fixed<2>("bottom", u, 0),
                                               loaded<2>("right", normal, 0), loaded<2>("top", 0, lateral)},
                                .material = lame(2.5, 0.25)},
                               {.degree = p});
    const certify::Balance b = balance_of<2>(c, {0, 0});
    const double shared = 0.5 * (p == 1 ? 0.25 : 0.5 / 6);  // half of the corner's length of a facet
    const auto& left = find(b, certify::BalanceKind::reaction, "left");
    const auto& bottom = find(b, certify::BalanceKind::reaction, "bottom");
    EXPECT_NEAR(left.force[0], -normal * (1 - shared), 1e-12);
    EXPECT_NEAR(left.force[1], -lateral * shared, 1e-12);
    EXPECT_NEAR(bottom.force[0], -normal * shared, 1e-12);
    EXPECT_NEAR(bottom.force[1], -lateral * (2 - shared), 1e-12);
    EXPECT_LE(defect(b).moment, 1e-12);
  }
}

/// A block on a frictionless floor with rollers: the floor carries the weight, the rollers carry the push.
/// Statics does not determine how the moments are shared.
TEST(Balance, ContactAndRollersIn3D)
{
  const DiscreteProblem<3> c(
      block<3>({2, 1, 1}),
      {.boundaries = {fixed<3>("left", 0, free, free), fixed<3>("back", free, free),
                      loaded<3>("right", -0.1, 0), pressed<3>("front", 0.2), obstacle<3>("bottom")},
       .material = lame(1, 0.25),
       .body_force = {0, -0.3}},
      {.degree = 2});
  const certify::Balance b = balance_of<3>(c, certify::centroid<3>(c.mesh));
  EXPECT_EQ(b.about, (std::vector<double>{1, 0.5, 0.5}));
  const auto expect =
      [&](certify::BalanceKind kind, const std::string& name, const std::vector<double>& force)
  {
    SCOPED_TRACE(name);
    const certify::BalanceRow& row = find(b, kind, name);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(row.force[i], force[i], 1e-11);
  };
  expect(certify::BalanceKind::load, "front", {0, 0, -0.4});
  expect(certify::BalanceKind::reaction, "left", {0.1, 0, 0});
  expect(certify::BalanceKind::reaction, "back", {0, 0, 0.4});
  expect(certify::BalanceKind::contact, "bottom", {0, 0.6, 0});
  // A component that is not fixed has no reaction.
  EXPECT_EQ(find(b, certify::BalanceKind::reaction, "left").force[1], 0);
}

/// In 3D the moment is r x f: one force along each axis, each on its own face.
TEST(Balance, MomentsIn3D)
{
  const DiscreteProblem<3> c(
      block<3>({2, 1, 1}),
      {.boundaries = {clamped<3>("left"), loaded<3>("right", 0, 0.3, -0.2), loaded<3>("top", 0.1, 0)},
       .material = lame(1, 0.25)},
      {.degree = 2});
  const certify::Balance b = balance_of<3>(c, {0, 0, 0});
  // right: at (2, 1/2, 1/2) the force (0, 0.3, -0.2); top: at (1, 1, 1/2) the force (0.2, 0, 0)
  const std::vector<double> moment = {0.5 * -0.2 - 0.5 * 0.3, 2 * 0.2 + 0.5 * 0.2, 2 * 0.3 - 0.2};
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(find(b, certify::BalanceKind::reaction, "left").moment[i], -moment[i], 1e-11);
}

}  // namespace
}  // namespace tribound::test
