#pragma once

/// @file loads_reference.h
/// Numbers of an independent program for springs, sliders and initial stress: data/loads.json.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/springs.h"

namespace tribound::test
{

/// The energy with that of springs and the norm of the stress to 1e-8, the bound to 1e-6, for every degree
/// and mesh of a case. The program replaces an initial stress by its projection on P^p and leaves out the
/// distance.
inline void expect_reference(const std::string& name, const ProblemData<2>& data)
{
  std::ifstream file(LOADS_REFERENCE);
  int found = 0;
  for (const nlohmann::json& expected : nlohmann::json::parse(file))
  {
    if (expected["case"] != name) continue;
    ++found;
    const DiscreteProblem<2> c(block<2>({expected["nx"], expected["ny"]}), data,
                               {.degree = expected["p"], .newton = {.tolerance = 1e-12}});
    const solve::NewtonResult<2> solved = c.solve();
    const auto near = [&](double value, const char* key, double digits)
    {
      const double number = expected[key];
      EXPECT_NEAR(value, number, digits * number) << name << ", " << key << ", p = " << expected["p"];
    };
    double rest = 0;  // ||sigma_0 - Pi^p sigma_0||^2
    for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
      rest += std::pow(c.form.data().initial_stress().remainder(cell).oscillation, 2);
    const contact::StressNorms norms = contact::stress_norms<2>(c.problem, c.space, solved.u);
    const double of_springs = c.form.springs().energy(solved.u);
    near(norms.energy + of_springs, "energy", 1e-8);
    near(std::sqrt(norms.sigma * norms.sigma - rest), "sigma_norm", 1e-8);
    const auto stress =
        certify::equilibrate<2>(c.form, solved.u, solved.traction, 0, 0, certify::PatchStress::afw);
    const certify::Estimate bound =
        certify::estimate<2>(c.form, solved.u, stress, certify::ContactRule::reference);
    near(std::sqrt(bound.total * bound.total - rest), "bound", 1e-6);
    if (!expected["dual_norm"].is_null())
    {
      EXPECT_GE(bound.total, expected["dual_norm"].get<double>());
    }
  }
  EXPECT_GE(found, 3);
}

}  // namespace tribound::test
