/// @file certify_test.cpp
/// The equilibrated stress and the components of the bound: against the numbers of an independent program
/// (tests/verification/data/t2d.json) and exact solutions. The identities: identities_test.cpp.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "certify/equilibrate.h"
#include "certify/estimate.h"
#include "support/discrete_case.h"
#include "support/t2d.h"

namespace tribound::test
{

namespace
{

using nlohmann::json;

class Components : public ::testing::TestWithParam<int>
{
};

TEST_P(Components, AgreeWithTheReferenceAtEveryIterate)
{
  const json expected = t2d_reference().at(GetParam());
  for (const int k : {0, 1, 2})
  {
    DiscreteCase<2> c(t2d_toml(expected["p"], expected["nx"], expected["ny"]));
    if (k > 0) c.config.newton.max_steps = k;
    const NewtonResult<2> result = c.solve();
    const Stress<2> stress = equilibrate<2>(c.form, result.u, result.traction);
    const Estimate eta = estimate<2>(c.form, result.u, stress, ContactRule::reference);
    const json& e = expected[k == 0 ? "converged_est" : "iterate" + std::to_string(k) + "_est"];
    const double tolerance = 1e-7 * e["eta_tot"].get<double>();
    const auto expect = [&](double value, const char* name) {
      EXPECT_NEAR(value, e[name].get<double>(), tolerance) << name << ", iterate " << k << " (0: converged)";
    };
    expect(eta.global.osc, "eta_osc");
    expect(eta.global.str, "eta_str");
    expect(eta.global.neu, "eta_Neu");
    expect(eta.global.lin1, "eta_lin1");
    expect(eta.global.cnt, "eta_cnt");
    expect(eta.global.frc, "eta_frc");
    expect(eta.global.lin2n, "eta_lin2n");
    expect(eta.global.lin2t, "eta_lin2t");
    expect(eta.total, "eta_tot");
    EXPECT_LE(eta.total_sharp, eta.total * (1 + 1e-14));
  }
}

INSTANTIATE_TEST_SUITE_P(T2D, Components, ::testing::Range(0, 8));

TEST(Equilibrate, DoesNotDependOnTheNumberOfThreads)
{
  const DiscreteCase<2> c(t2d_toml(2, 8, 4));
  const NewtonResult<2> result = c.solve();
  const Stress<2> one = equilibrate<2>(c.form, result.u, result.traction, 1);
  const Stress<2> three = equilibrate<2>(c.form, result.u, result.traction, 3);
  EXPECT_EQ(one.dis, three.dis);
  EXPECT_EQ(one.lin, three.lin);
}

TEST(Estimate, VanishesForAConstantStress)
{
  // u = (A x + c + B y, D y) slips on y = 0, see the reference solutions.
  for (int p = 1; p <= 4; ++p)
  {
    const std::string exact = "[\"0.1*x + 0.05 + 0.2*y\", \"-0.3*y\"]";
    const std::string toml = "degree = " + std::to_string(p) +
                             "\nmesh.box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }\n"
                             "material = { E = 2.5, nu = 0.25 }\nnewton.tolerance = 1e-13\n"
                             "boundary.left.displacement = " +
                             exact + "\nboundary.top.displacement = " + exact +
                             "\nboundary.right.traction = [\"(1+2)*0.1 - 0.3\", 0.2]\n"
                             "boundary.bottom.contact = { friction = \"tresca\", threshold = 0.2 }\n";
    const DiscreteCase<2> c(toml);
    const NewtonResult<2> result = c.solve();
    ASSERT_EQ(result.status, NewtonStatus::converged);
    const Estimate eta = estimate<2>(c.form, result.u, equilibrate<2>(c.form, result.u, result.traction));
    EXPECT_LE(eta.total, 1e-11) << "p = " << p;
  }
}

}  // namespace

}  // namespace tribound::test
