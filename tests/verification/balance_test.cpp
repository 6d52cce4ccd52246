/// @file balance_test.cpp
/// Loads, reactions and contact forces: their sum vanishes to rounding at every Newton iterate, and the parts
/// are those of a hand calculation.

#include "tribound/certify/bound/balance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/discrete_case.h"
#include "tribound/certify/equilibrate/equilibrate.h"

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

/// What the sum leaves of the largest force and moment.
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
    if (row.moment) moment = std::max(moment, largest(*row.moment));
  }
  const certify::BalanceRow& sum = balance.rows.back();
  return {largest(sum.force) / force, sum.moment ? largest(*sum.moment) / moment : 0};
}

template <int dim>
certify::Balance balance_of(const DiscreteCase<dim>& c, const Point<dim>& about)
{
  const solve::NewtonResult<dim> result = c.solve();
  return certify::balance<dim>(c.form, certify::equilibrate<dim>(c.form, result.u, result.traction), about);
}

const certify::BalanceRow& find(const certify::Balance& balance, certify::BalanceKind kind,
                                const std::string& name)
{
  const auto row = std::ranges::find_if(
      balance.rows, [&](const certify::BalanceRow& r) { return r.kind == kind && r.name == name; });
  EXPECT_NE(row, balance.rows.end()) << name;
  return *row;
}

struct Law
{
  const char* name;
  const char* contact;
};

constexpr std::array laws = {
    Law{"none", "{ gap = \"0.002*(1 + sin(3*x))\" }"},
    Law{"Tresca", "{ friction = \"tresca\", threshold = \"0.01 + 0.005*sin(x)\" }"},
    Law{"Coulomb", "{ friction = \"coulomb\", coefficient = 0.4, gap = \"0.002*(1 + sin(3*x))\" }"}};

/// Body force, traction, pressure, a clamp that is inclined against the contact boundary by a roller, contact
/// on one side; nothing vanishes and no datum is a polynomial.
std::string block(int dim, int p, const char* contact)
{
  const std::string text = fmt::format(
      "degree = {}\nmaterial = {{ E = 1.0, nu = 0.3 }}\nnewton.tolerance = 1e-12\nnewton.damping = false\n"
      "boundary.bottom.contact = {}\nboundary.top.pressure = \"0.05*exp(x)\"\n",
      p, contact);
  if (dim == 2)
    return text +
           "mesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }\n"
           "load.body = [\"0.1*sin(5*x)*exp(y)\", \"-0.1*exp(x*y)\"]\n"
           "boundary.left = { displacement = [0, \"free\"], traction = [0, 0.01] }\n"
           "boundary.right.traction = [0.02, \"0.01*sin(y)\"]\n";
  return text +
         "mesh.box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 1, 1] }\n"
         "load.body = [\"0.1*sin(5*x)*exp(y)\", \"-0.1*exp(x*y)\", \"0.02*cos(z)\"]\n"
         "boundary.left.displacement = [0, 0, 0]\n"
         "boundary.back = { displacement = [\"free\", \"free\", 0], traction = [0.01, 0, 0] }\n"
         "boundary.right.traction = [0.02, \"0.01*sin(y)\", 0.005]\n";
}

template <int dim>
void every_iterate(int p)
{
  Defect worst;
  const Point<dim> about = Point<dim>::Constant(0.3);
  int iterates = 0;
  for (const Law& law : laws)
  {
    SCOPED_TRACE(law.name);
    const DiscreteCase<dim> c(block(dim, p, law.contact));
    const auto examine = [&](const solve::NewtonIterate<dim>& iterate)
    {
      const certify::Balance b = certify::balance<dim>(
          c.form, certify::equilibrate<dim>(c.form, iterate.u, iterate.traction), about);
      EXPECT_EQ(b.rows.back().moment.has_value(), p > 1);
      const Defect d = defect(b);
      ++iterates;
      EXPECT_LE(d.force, 1e-11) << "iterate " << iterates;
      EXPECT_LE(d.moment, 1e-11);
      worst = {std::max(worst.force, d.force), std::max(worst.moment, d.moment)};
      return solve::NewtonAdvice(false);
    };
    (void)solve::solve<dim>(c.form, {}, c.config.method.newton, c.config.method.solver, examine);
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

/// A cantilever of length 3 and height 2, clamped at the left, under its weight, a triangular pressure
/// on top (3 x / 3 per length), a shear on the right. By statics the clamp carries the resultants.
TEST(Balance, StaticallyDeterminateCantilever)
{
  const DiscreteCase<2> c(
      "degree = 2\nmaterial = { E = 1.0, nu = 0.3 }\n"
      "mesh.box = { lower = [0, 0], upper = [3, 2], cells = [3, 2] }\n"
      "load.body = [0, -0.5]\nboundary.left.displacement = [0, 0]\n"
      "boundary.top = { pressure = \"x\", traction = [0.25, 0] }\nboundary.right.traction = [0, 0.1]\n");
  const certify::Balance b = balance_of<2>(c, {0, 1});
  const auto expect = [&](certify::BalanceKind kind, const std::string& name, const std::string& source,
                          std::vector<double> force, double moment)
  {
    SCOPED_TRACE(name);
    const certify::BalanceRow& row = find(b, kind, name);
    EXPECT_EQ(row.source, source);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(row.force[i], force[i], 1e-11);
    EXPECT_NEAR((*row.moment)[0], moment, 1e-11);
  };
  expect(certify::BalanceKind::load, "box", "body force", {0, -3}, -3 * 1.5);
  // pressure: 9/2 at x = 2; traction: 3/4 at height 1 above the point
  expect(certify::BalanceKind::load, "top", "traction and pressure", {0.75, -4.5}, -4.5 * 2 - 0.75);
  expect(certify::BalanceKind::load, "right", "traction", {0, 0.2}, 0.2 * 3);
  expect(certify::BalanceKind::reaction, "left", "displacement", {-0.75, 7.3}, 4.5 + 9 + 0.75 - 0.6);
  EXPECT_EQ(b.rows.size(), 5u);
}

/// A block on a frictionless floor with rollers: the floor carries the weight, the rollers what pushes.
/// How the moments are shared is not a matter of statics.
TEST(Balance, ContactAndRollersIn3D)
{
  const DiscreteCase<3> c(
      "degree = 2\nmaterial = { E = 1.0, nu = 0.25 }\n"
      "mesh.box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 1, 1] }\n"
      "load.body = [0, -0.3, 0]\nboundary.left.displacement = [0, \"free\", \"free\"]\n"
      "boundary.back.displacement = [\"free\", \"free\", 0]\nboundary.right.traction = [-0.1, 0, 0]\n"
      "boundary.front.pressure = 0.2\nboundary.bottom.contact = {}\n");
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
  // A component that is not fixed has no reaction at all.
  EXPECT_EQ(find(b, certify::BalanceKind::reaction, "left").force[1], 0);
}

/// In 3D the moment is r x f: one force along each axis on a face of its own.
TEST(Balance, MomentsIn3D)
{
  const DiscreteCase<3> c(
      "degree = 2\nmaterial = { E = 1.0, nu = 0.25 }\n"
      "mesh.box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 1, 1] }\n"
      "boundary.left.displacement = [0, 0, 0]\nboundary.right.traction = [0, 0.3, -0.2]\n"
      "boundary.top.traction = [0.1, 0, 0]\n");
  const certify::Balance b = balance_of<3>(c, {0, 0, 0});
  // right: at (2, 1/2, 1/2) the force (0, 0.3, -0.2); top: at (1, 1, 1/2) the force (0.2, 0, 0)
  const std::vector<double> moment = {0.5 * -0.2 - 0.5 * 0.3, 2 * 0.2 + 0.5 * 0.2, 2 * 0.3 - 0.2};
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR((*find(b, certify::BalanceKind::reaction, "left").moment)[i], -moment[i], 1e-11);
}

}  // namespace
}  // namespace tribound::test
