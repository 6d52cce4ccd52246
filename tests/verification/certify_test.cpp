/// @file certify_test.cpp
/// The equilibrated stress and the components of the bound: against the numbers of an independent program
/// (tests/verification/data/t2d.json), the identities of method section 4, and exact solutions.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "certify/checks.h"
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

/// A block with body force, varying loads and rollers around its corners.
std::string block(int dimension, int p, const std::string& sides)
{
  const std::string box = dimension == 2 ? "{ lower = [0, 0], upper = [2, 1], cells = [5, 3] }"
                                         : "{ lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 2, 2] }";
  const std::string body =
      dimension == 2 ? "[\"0.1*x*y\", \"-0.1*(1+x^2)\"]" : "[\"0.1*x*y\", \"-0.1*(1+x^2)\", \"0.05*z*x\"]";
  return "degree = " + std::to_string(p) + "\nmesh.box = " + box +
         "\nmaterial = { E = 1.0, nu = 0.3 }\nload.body = " + body + "\nnewton.damping = false\n" + sides;
}

template <int dim>
void expect_identities(const std::string& toml, double bound)
{
  for (const int k : {1, 2, 30})
  {
    DiscreteCase<dim> c(toml);
    c.config.newton.max_steps = k;
    const NewtonResult<dim> result = c.solve();
    const Stress<dim> stress = equilibrate<dim>(c.form, result.u, result.traction);
    const IdentityDefects defects = check_identities<dim>(c.form, result.traction, stress);
    EXPECT_LE(defects.divergence, bound) << toml << "iterate " << k;
    EXPECT_LE(defects.jump, bound) << toml << "iterate " << k;
    EXPECT_LE(defects.neumann, bound) << toml << "iterate " << k;
    EXPECT_LE(defects.contact, bound) << toml << "iterate " << k;
    if (c.config.degree > 1)
    {
      EXPECT_LE(defects.symmetry, bound) << toml << "iterate " << k;
    }
  }
}

double identity_bound(int p)
{
  return p <= 2 ? 1e-11 : 1e-10;
}

class Identities : public ::testing::TestWithParam<int>
{
};

constexpr auto tresca =
    "boundary.bottom.contact = { friction = \"tresca\", threshold = \"0.02 + 0.01*x\" }\n";
constexpr auto coulomb =
    "boundary.bottom.contact = { friction = \"coulomb\", coefficient = 0.4, gap = \"0.01*x\" }\n";

TEST_P(Identities, HoldIn2D)
{
  const int p = GetParam();
  const std::string top = "boundary.top.traction = [0, \"-0.1*exp(x)\"]\n";
  for (const std::string contact : {tresca, coulomb})
    for (const std::string left : {"[0, 0]", "[0, \"free\"]"})
      for (const std::string right : {"boundary.right.traction = [0.02, \"0.01*sin(y)\"]\n",
                                      "boundary.right.displacement = [\"free\", 0]\n", ""})
        expect_identities<2>(
            block(2, p, contact + "boundary.left.displacement = " + left + "\n" + right + top),
            identity_bound(p));
}

TEST_P(Identities, HoldIn3D)
{
  const int p = GetParam();
  if (p > 3) GTEST_SKIP() << "p = 4 is checked in 2D";
  const std::string sides =
      "boundary.left.displacement = [0, \"free\", 0]\n"
      "boundary.back.displacement = [\"free\", \"free\", 0]\n"
      "boundary.top.traction = [0, \"-0.1*exp(x)\", 0.01]\n";
  for (const std::string contact : {tresca, coulomb})
    expect_identities<3>(block(3, p, contact + sides), identity_bound(p));
}

INSTANTIATE_TEST_SUITE_P(Degrees, Identities, ::testing::Range(1, 5));

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
