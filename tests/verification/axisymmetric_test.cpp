/// @file axisymmetric_test.cpp
/// Bodies of revolution: numbers of an independent program, and the bound against the dual norm in random
/// cases on and off the axis.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "support/meridian_problem.h"
#include "support/random_cases.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

namespace
{

/// Pressed and pulled on its outer side, and off the axis on its inner side; on an obstacle below.
ProblemData<2> reference_problem(double inner, const problem::ContactLaw& law)
{
  ProblemData<2> data{.boundaries = {loaded<2>("top", formula("0.05*x"), -0.1),
                                     loaded<2>("right", 0.04, formula("0.02*y")),
                                     obstacle<2>("bottom", law, formula("0.02*x^2"))}};
  if (inner > 0) data.boundaries.push_back(loaded<2>("left", 0.03, 0));
  data.body_force = {0.0, -0.02};
  return data;
}

TEST(Axisymmetric, ReferenceNumbers)
{
  std::ifstream file(AXISYMMETRY_REFERENCE);
  for (const nlohmann::json& expected : nlohmann::json::parse(file))
  {
    const double inner = expected["r0"];
    const int p = expected["p"];
    const int n = expected["n"];
    const bool rubs = expected["law"] == "coulomb";
    const problem::ContactLaw law = rubs ? problem::ContactLaw(Coulomb(0.3)) : Frictionless();
    const MeridianProblem c(box<2>({inner, 0}, {1, 1}, {n, n}), reference_problem(inner, law),
                            {.degree = p, .gamma0 = 10, .newton = {.tolerance = 1e-13}});
    const std::string name =
        fmt::format("{}, p = {}, n = {}, inner = {}", rubs ? "coulomb" : "none", p, n, inner);
    const solve::NewtonResult<2> solved = c.solve();
    const auto near = [&](double value, double number, double digits, const char* key)
    { EXPECT_NEAR(value, number, digits * std::abs(number)) << name << ", " << key; };
    near(contact::stress_norms<2>(c.problem, c.space, solved.u).energy, expected["energy"], 1e-9, "energy");
    const contact::ContactResultants<2> force = contact::contact_resultants<2>(c.form, solved.traction);
    near(force.force[1], -expected["normal"].get<double>(), 1e-9, "normal");
    EXPECT_NEAR(force.force[0], expected["tangential"].get<double>(), 1e-11) << name;

    const certify::Stress<2> stress = certify::equilibrate<2>(c.form, solved.u, solved.traction);
    const certify::Estimate bound = certify::estimate<2>(c.form, solved.u, stress);
    const nlohmann::json& parts = expected["bound_parts"];
    near(bound.global.str, parts["str"], 1e-6, "str");
    near(bound.global.cnt, parts["cnt"], 1e-6, "cnt");
    EXPECT_NEAR(bound.global.frc, parts["frc"].get<double>(), 1e-6 * bound.global.cnt) << name << ", frc";
    EXPECT_LE(bound.global.osc, 1e-12) << name;  // f is constant
    certify::DualNorm<2> dual_norm(c.form, {.refinements = 0, .degree = p + 3});
    near(dual_norm(solved.u), expected["dual"], 1e-6, "dual");
  }
}

/// A law, loads and a support at random; in half of the cases on the axis.
ProblemData<2> random_problem(std::mt19937& random, double inner)
{
  std::uniform_real_distribution<double> number(-1, 1);
  const auto linear = [&](double size)
  {
    return formula(fmt::format("{:.6f} + {:.6f}*x + {:.6f}*y*x", size * number(random), size * number(random),
                               size * number(random)));
  };
  const std::vector<problem::ContactLaw> laws = {Frictionless(), Tresca(0.01), Coulomb(0.4), Tied()};
  ProblemData<2> data{
      .boundaries = {obstacle<2>("bottom", laws[random() % laws.size()],
                                 formula(fmt::format("{:.6f}*x^2", 0.05 * std::abs(number(random)))))},
      .material = lame(1, 0.15 + 0.3 * std::abs(number(random)))};
  data.boundaries.push_back(
      random() % 2 == 0 ? loaded<2>("top", linear(0.05), -0.1)
                        : fixed<2>("top", random() % 2 == 0 ? std::optional<problem::Field>(0.0) : free,
                                   formula("-0.03 - 0.01*x")));
  data.boundaries.push_back(loaded<2>("right", linear(0.05), linear(0.03)));
  if (inner > 0) data.boundaries.push_back(loaded<2>("left", linear(0.05), 0));
  data.body_force = random() % 2 == 0 ? std::array<problem::Field, 2>{0.01, -0.02}
                                      : std::array<problem::Field, 2>{linear(0.05), linear(0.05)};
  return data;
}

TEST(Axisymmetric, BoundIsNotBelowTheDualNorm)
{
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
  {
    std::mt19937 random(seed);
    const double inner = seed % 2 == 0 ? 0 : 0.05 + 0.1 * (seed % 5);
    const int p = 1 + static_cast<int>(seed / 2) % 3;
    MeridianProblem c(random_meridian(inner, 2 + static_cast<int>(random() % 3), seed),
                      random_problem(random, inner), {.degree = p, .newton = {.tolerance = 1e-11}});
    certify::DualNorm<2> dual_norm(c.form, {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
    std::string line = fmt::format("seed {}: p = {}, inner = {}", seed, p, inner);
    const int all_steps = c.method.newton.max_steps;
    for (const int steps : {1, 2, all_steps})
    {
      c.method.newton.max_steps = steps;
      const solve::NewtonResult<2> newton = c.solve();
      const double below = dual_norm(newton.u);
      const certify::Estimate eta =
          certify::estimate<2>(c.form, newton.u, certify::equilibrate<2>(c.form, newton.u, newton.traction));
      EXPECT_GE(eta.total_sharp, below) << line;
      if (steps == all_steps)
      {
        EXPECT_LE(eta.total_sharp, 1.3 * below) << line;
      }
      line += fmt::format("  k = {:<2} {:.4f}", newton.steps.size(), eta.total_sharp / below);
    }
    std::cout << line << std::endl;
  }
}

}  // namespace

}  // namespace tribound::test
