/// @file axisymmetric_loads_test.cpp
/// Bodies of revolution with initial stress, temperature, springs, sliders, rigid parts and water: exact
/// solutions, forces in balance, and the bound against the dual norm in random cases on and off the axis.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "support/random_meridian_problem.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "verification/heated_cylinder.h"
#include "verification/random_meridian_bound.h"

namespace tribound::test
{

namespace
{

certify::Estimate estimate(const MeridianProblem& c, const solve::NewtonResult<2>& solved)
{
  return certify::estimate<2>(c.form, solved.u, certify::equilibrate<2>(c.form, solved.u, solved.traction));
}

/// Temperatures linear in z expand a body without stress: u_r = alpha theta r, u_z = alpha (int theta dz - b
/// r^2 / 2) with theta = a + b z.
TEST(AxisymmetricLoads, FreeExpansionHasNoStress)
{
  constexpr double alpha = 1e-3;
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3})
    {
      const double a = 2;
      const double b = p == 1 ? 0 : 0.7;
      ProblemData<2> data{
          .boundaries = {fixed<2>("bottom", free, formula(fmt::format("{:.17g}*x^2", -alpha * b / 2)))}};
      data.regions = {heated(alpha, formula(fmt::format("{} + {}*y", a, b)))};
      const MeridianProblem c(random_meridian(inner, 3, 7), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const solve::NewtonResult<2> solved = c.solve();
      const std::vector<Point<2>> nodes = c.space.node_points();
      for (Index i = 0; i < c.space.n_nodes(); ++i)
      {
        const auto& [r, z] = std::pair(nodes[i][0], nodes[i][1]);
        EXPECT_NEAR(solved.u[2 * i], alpha * (a + b * z) * r, 1e-14);
        EXPECT_NEAR(solved.u[2 * i + 1], alpha * (a * z + b * z * z / 2 - b * r * r / 2), 1e-14);
      }
      EXPECT_LE(contact::stress_norms<2>(c.form, solved.u).sigma, 1e-14);
      EXPECT_LE(estimate(c, solved).total_sharp, 1e-14) << inner << ", p = " << p;
    }
}

/// sigma_rr = r^2 and sigma_tt = 3 r^2 are in equilibrium: nothing moves under the traction r^2 n. r sigma_0
/// is in P^p for p = 3.
TEST(AxisymmetricLoads, InitialStressInEquilibriumStaysAsItIs)
{
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3})
    {
      ProblemData<2> data{.boundaries = {fixed<2>("bottom", free, 0.0), loaded<2>("right", 1.0, 0.0)}};
      if (inner > 0) data.boundaries.push_back(loaded<2>("left", -inner * inner, 0.0));
      problem::Region<2> region = heated(0, 0.0);
      region.initial_stress[0] = formula("x^2");
      region.initial_stress_zz = formula("3*x^2");
      data.regions = {region};
      const MeridianProblem c(random_meridian(inner, 3, 7), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const solve::NewtonResult<2> solved = c.solve();
      for (const double value : solved.u) EXPECT_NEAR(value, 0, 1e-13);
      const double sigma = contact::stress_norms<2>(c.form, solved.u).sigma;
      const double r6 = (1 - std::pow(inner, 6)) / 6;  // the integral of r r^4
      if (p >= 2)
      {
        EXPECT_NEAR(sigma, std::sqrt(10 * r6), 1e-12);
      }
      const double bound = estimate(c, solved).total_sharp;
      EXPECT_LE(bound, p == 3 ? 1e-12 : 0.05 * sigma) << inner << ", p = " << p;
    }
}

TEST(AxisymmetricLoads, HeatedCylinder)
{
  const HeatedCylinder cylinder;
  ProblemData<2> data{.boundaries = {fixed<2>("bottom", free, 0.0), fixed<2>("top", free, 0.0)}};
  data.regions = {heated(cylinder.alpha, cylinder.temperature())};
  for (const int p : {1, 2, 3})
  {
    std::vector<double> errors;
    std::vector<double> bounds;
    for (const int n : {4, 8})
    {
      const MeridianProblem c(box<2>({1, 0}, {2, 0.5}, {n, n / 2}), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const solve::NewtonResult<2> solved = c.solve();
      const std::vector<Point<2>> nodes = c.space.node_points();
      double error = 0;
      for (Index i = 0; i < c.space.n_nodes(); ++i)
        error = std::max(error, std::abs(solved.u[2 * i] - cylinder.u_r(nodes[i][0])));
      errors.push_back(error / cylinder.u_r(2));
      bounds.push_back(estimate(c, solved).total_sharp);
    }
    EXPECT_LE(errors[1], errors[0] / std::pow(2, p)) << p;
    EXPECT_LE(errors[1], 0.03 / std::pow(20, p - 1)) << p;
    EXPECT_LE(bounds[1], 1.2 * bounds[0] / std::pow(2, p)) << p;
  }
}

/// A disc on springs under a pressure p goes down by p / k, everywhere.
TEST(AxisymmetricLoads, SpringsCarryTheFullCircle)
{
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3})
    {
      problem::BoundaryCondition<2> springs;
      springs.name = "bottom";
      springs.spring = problem::Spring<2>{2.0, 0.0};
      const ProblemData<2> data{.boundaries = {springs, loaded<2>("top", 0.0, -0.1)}, .material = lame(1, 0)};
      const MeridianProblem c(random_meridian(inner, 3, 5), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const solve::NewtonResult<2> solved = c.solve();
      const std::vector<Point<2>> nodes = c.space.node_points();
      for (Index i = 0; i < c.space.n_nodes(); ++i)
        EXPECT_NEAR(solved.u[2 * i + 1], -0.05 - 0.1 * nodes[i][1], 1e-12);
      const double force = 0.1 * std::numbers::pi * (1 - inner * inner);
      const certify::Balance balance =
          certify::balance<2>(c.form, solved.u, solved.traction, Point<2>::Zero());
      for (const certify::BalanceRow& row : balance.rows)
        if (row.kind == certify::BalanceKind::spring)
        {
          EXPECT_NEAR(row.force[1], force, 1e-12);
        }
      EXPECT_NEAR(balance.rows.back().force[1], 0, 1e-12);
      EXPECT_LE(estimate(c, solved).total_sharp, 1e-12);
    }
}

/// A rigid plate presses a cylinder that does not bulge: the force is that on the full circle.
TEST(AxisymmetricLoads, RigidPlateCarriesTheForceOfTheFullCircle)
{
  problem::RigidPart<2> part;
  part.force[1] = -0.6;
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3})
    {
      problem::BoundaryCondition<2> plate;
      plate.name = "top";
      plate.rigid = part;
      const ProblemData<2> data{.boundaries = {plate, fixed<2>("bottom", free, 0.0)}, .material = lame(1, 0)};
      const MeridianProblem c(random_meridian(inner, 3, 5), data,
                              {.degree = p, .newton = {.tolerance = 1e-13}});
      const solve::NewtonResult<2> solved = c.solve();
      const double stress = 0.6 / (std::numbers::pi * (1 - inner * inner));
      const std::vector<Point<2>> nodes = c.space.node_points();
      for (Index i = 0; i < c.space.n_nodes(); ++i)
        EXPECT_NEAR(solved.u[2 * i + 1], -stress * nodes[i][1], 1e-12);
      const auto motion = c.form.rigid_parts().motions(c.problem, solved.u).at(0);
      EXPECT_NEAR(motion.translation[1], -stress, 1e-12);
      EXPECT_EQ(motion.rotation[0], 0);
      const certify::Balance balance =
          certify::balance<2>(c.form, solved.u, solved.traction, Point<2>::Zero());
      EXPECT_NEAR(balance.rows.front().force[1], -0.6, 1e-15);
      EXPECT_NEAR(balance.rows.back().force[1], 0, 1e-12);
      EXPECT_LE(estimate(c, solved).total_sharp, 1e-12);
    }
}

TEST(AxisymmetricLoads, BoundIsNotBelowTheDualNorm)
{
  expect_above_dual_norm_of_random(
      random_meridian_problem,
      [](const BoundedMeridian& found)
      {
        const contact::NitscheForm<2>& form = found.problem.form;
        const auto& [u, traction] = std::tie(found.newton.u, found.newton.traction);
        EXPECT_LE(
            certify::check_identities<2>(form, traction, found.stress,
                                         certify::Estimator<2>(form).algebraic_remainder(u, found.stress))
                .largest(),
            1e-11)
            << found.name;
        const certify::Balance balance = certify::balance<2>(form, u, traction, Point<2>::Zero());
        EXPECT_NEAR(balance.rows.back().force[1], 0, 1e-10) << found.name;
      });
}

}  // namespace

}  // namespace tribound::test
