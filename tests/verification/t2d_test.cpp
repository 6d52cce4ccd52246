/// @file t2d_test.cpp
/// Problem T2D (Tresca friction) against the numbers of an independent program,
/// tests/verification/data/t2d.json.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "support/discrete_problem.h"
#include "support/t2d.h"

namespace tribound::test
{

namespace
{

using nlohmann::json;

/// Agreement to 8 digits.
void expect_digits(double value, const json& expected, const std::string& what)
{
  const double e = expected.get<double>();
  EXPECT_NEAR(value, e, 5e-9 * std::abs(e)) << what;
}

double max_displacement(const DiscreteProblem<2>& c, std::span<const double> u)
{
  double largest = 0;
  for (Index i = 0; i < c.space.n_nodes(); ++i)
    largest = std::max(largest, std::hypot(u[2 * i], u[2 * i + 1]));
  return largest;
}

class T2D : public ::testing::TestWithParam<int>
{
};

TEST_P(T2D, ConvergedSolution)
{
  const json expected = t2d_reference().at(GetParam());
  const DiscreteProblem<2> c = t2d(expected["p"], expected["nx"], expected["ny"]);
  EXPECT_EQ(fem::n_free_dofs(c.space, c.form.constraints()), expected["dofs"].get<int>());
  const solve::NewtonResult<2> result = c.solve();
  ASSERT_EQ(result.status, solve::NewtonStatus::converged) << result.message;
  EXPECT_LE(result.steps.size(), expected["newton_iterations"].get<std::size_t>() + 1);

  const contact::StressNorms norms = contact::stress_norms<2>(c.problem, c.space, result.u);
  expect_digits(norms.energy, expected["energy"], "energy");
  expect_digits(norms.sigma, expected["converged_est"]["sigma_norm"], "||sigma||");
  expect_digits(max_displacement(c, result.u), expected["max_abs_u"], "max |u|");
  const contact::ContactResultants<2> contact = contact::contact_resultants<2>(c.form, result.traction);
  expect_digits(contact.normal, expected["contact_normal"], "normal");
  expect_digits(contact.tangential, expected["contact_tangential"], "tangential");
  expect_digits(contact.abs_tangential, expected["abs_tangential"], "abs_tangential");
  expect_digits(contact.force[0], expected["contact_force_x"], "force x");
  expect_digits(contact.force[1], expected["contact_force_y"], "force y");
}

TEST_P(T2D, FirstAndSecondIterate)
{
  const json expected = t2d_reference().at(GetParam());
  for (const int k : {1, 2})
  {
    DiscreteProblem<2> c = t2d(expected["p"], expected["nx"], expected["ny"]);
    c.method.newton.max_steps = k;
    const solve::NewtonResult<2> result = c.solve();
    const std::string iterate = "iterate" + std::to_string(k);
    expect_digits(contact::stress_norms<2>(c.problem, c.space, result.u).sigma,
                  expected[iterate + "_est"]["sigma_norm"], iterate);
    const contact::ContactResultants<2> contact =
        contact::contact_resultants<2>(c.form, c.form.traction(result.u));
    expect_digits(contact.normal, expected[iterate + "_resultants"]["contact_normal"], iterate);
    expect_digits(contact.tangential, expected[iterate + "_resultants"]["contact_tangential"], iterate);
    expect_digits(contact.abs_tangential, expected[iterate + "_resultants"]["abs_tangential"], iterate);
  }
}

INSTANTIATE_TEST_SUITE_P(AllMeshes, T2D, ::testing::Range(0, 8));

}  // namespace

}  // namespace tribound::test
