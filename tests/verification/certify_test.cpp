/// @file certify_test.cpp
/// The equilibrated stress and the components of the bound, against the numbers of an independent program
/// (tests/verification/data/t2d.json) and exact solutions. For the identities see identities_test.cpp.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/discrete_problem.h"
#include "support/t2d.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"

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
    DiscreteProblem<2> c = t2d(expected["p"], expected["nx"], expected["ny"]);
    if (k > 0) c.method.newton.max_steps = k;
    const solve::NewtonResult<2> result = c.solve();
    const certify::Stress<2> stress =
        certify::equilibrate<2>(c.form, result.u, result.traction, 0, 0, certify::PatchStress::afw);
    const certify::Estimate eta =
        certify::estimate<2>(c.form, result.u, stress, certify::ContactRule::reference);
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
  const DiscreteProblem<2> c = t2d(2, 8, 4);
  const solve::NewtonResult<2> result = c.solve();
  const certify::Stress<2> one = certify::equilibrate<2>(c.form, result.u, result.traction, 1);
  const certify::Stress<2> three = certify::equilibrate<2>(c.form, result.u, result.traction, 3);
  EXPECT_EQ(one.dis, three.dis);
  EXPECT_EQ(one.lin, three.lin);
}

/// Successive iterates of a block with friction through one Equilibrator: nothing leaks from one into the
/// next, and sigma_lin computed alone equals that of the full computation.
template <int dim>
void expect_the_same_in_parts(DiscreteProblem<dim> c)
{
  certify::Equilibrator<dim> equilibrator(c.form, certify::PatchStress::rows, 2);
  const certify::Estimator<dim> estimator(c.form);
  for (const int k : {1, 2, 3})
  {
    c.method.newton.max_steps = k;
    const solve::NewtonResult<dim> newton = c.solve();
    const certify::Stress<dim> whole = certify::equilibrate<dim>(c.form, newton.u, newton.traction, 1);
    const certify::Stress<dim> lin = equilibrator.linearisation(newton.u, newton.traction);
    EXPECT_EQ(equilibrator(newton.u, newton.traction).dis, whole.dis);
    EXPECT_TRUE(lin.dis.empty());
    EXPECT_EQ(lin.lin_block, whole.lin_block);
    EXPECT_EQ(lin.lin, whole.lin);

    const certify::BoundComponents eta = estimator(newton.u, whole).global;
    const certify::BoundComponents part = estimator.linearisation(lin);
    EXPECT_GT(part.lin1, 0) << "iterate " << k;
    EXPECT_NEAR(part.lin1, eta.lin1, 1e-13 * eta.lin1);
    EXPECT_NEAR(part.lin2n, eta.lin2n, 1e-13 * eta.lin2n);
    EXPECT_NEAR(part.lin2t, eta.lin2t, 1e-13 * eta.lin2t);
    EXPECT_EQ(part.str + part.cnt + part.frc + part.osc + part.neu, 0);
  }
}

TEST(Equilibrator, KeepsNothingOfAnIterateAndGivesSigmaLinAlone)
{
  for (int p = 1; p <= 3; ++p)
  {
    ProblemData<2> plane = pressed_block<2>();
    plane.body_force = {formula("0.01*x"), -0.02};
    expect_the_same_in_parts<2>({block<2>({8, 4}), plane, t2d_method(p)});
    expect_the_same_in_parts<3>({block<3>({4, 2, 2}), pressed_block<3>(Coulomb(0.3)), {.degree = p}});
  }
}

TEST(Estimate, VanishesForAConstantStress)
{
  // u = (A x + c + B y, D y) slips on y = 0, see the reference solutions.
  for (int p = 1; p <= 4; ++p)
  {
    const problem::Field u_x = formula("0.1*x + 0.05 + 0.2*y");
    const problem::Field u_y = formula("-0.3*y");
    const DiscreteProblem<2> c(
        block<2>({4, 2}),
        {.boundaries = {fixed<2>("left", u_x, u_y), fixed<2>("top", u_x, u_y),
                        loaded<2>("right", (1 + 2) * 0.1 - 0.3, 0.2), obstacle<2>("bottom", Tresca(0.2))},
         .material = lame(2.5, 0.25)},
        {.degree = p, .newton = {.tolerance = 1e-13}});
    const solve::NewtonResult<2> result = c.solve();
    ASSERT_EQ(result.status, solve::NewtonStatus::converged);
    const certify::Estimate eta =
        certify::estimate<2>(c.form, result.u, certify::equilibrate<2>(c.form, result.u, result.traction));
    EXPECT_LE(eta.total, 1e-11) << "p = " << p;
  }
}

}  // namespace

}  // namespace tribound::test
