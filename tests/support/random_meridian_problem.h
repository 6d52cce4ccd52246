#pragma once

/// @file random_meridian_problem.h
/// Random bodies of revolution under all kinds of loads and supports.

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/meridian_problem.h"

namespace tribound::test
{

/// A region that is all of box().
inline problem::Region<2> heated(double alpha, problem::Field temperature)
{
  problem::Region<2> region{.name = "box", .material = lame(2, 0.3)};
  region.material.expansion = alpha;
  region.temperature = std::move(temperature);
  return region;
}

/// Temperature and initial stress, springs, a slider or a rigid part at random, on an obstacle with water in
/// the joint; for random_meridian(inner, ...).
inline ProblemData<2> random_meridian_problem(std::mt19937& random, double inner)
{
  std::uniform_real_distribution<double> number(-1, 1);
  const auto any = [&](double size)
  {
    const std::vector<std::string> shapes = {
        "1", "x", "y*x + x^2", "exp(x)", "sin(5*y + x)", "sqrt(0.1 + x)"};
    return formula(fmt::format("{:.6f} + {:.6f}*({})", size * number(random), size * number(random),
                               shapes[random() % shapes.size()]));
  };
  const std::vector<problem::ContactLaw> laws = {Frictionless(), Tresca(0.01), Coulomb(0.4)};
  ProblemData<2> data{.boundaries = {obstacle<2>("bottom", laws[random() % laws.size()])}};
  if (random() % 2 == 0) data.boundaries[0].contact->water = problem::Water(formula("0.05 + 0.02*x"));
  problem::Region<2> region = heated(0.02, any(1));
  region.material = lame(1, 0.15 + 0.3 * std::abs(number(random)));
  region.material.expansion = 0.02;
  for (problem::Field& entry : region.initial_stress) entry = any(0.03);
  region.initial_stress_zz = any(0.03);
  data.regions = {region};
  problem::BoundaryCondition<2> side = loaded<2>("right", any(0.05), any(0.03));
  if (random() % 2 == 0)
    side.spring = problem::Spring<2>{0.7, formula("0.3 + 0.2*y"), {formula("0.01*y"), any(0.02)}};
  data.boundaries.push_back(side);
  if (inner > 0) data.boundaries.push_back(loaded<2>("left", any(0.05), 0));
  switch (random() % 3)
  {
    case 0:
      data.boundaries.push_back(obstacle<2>("top", problem::Slider(), formula("-0.04 + 0.01*x")));
      break;
    case 1:
    {
      problem::BoundaryCondition<2> plate;
      plate.name = "top";
      plate.rigid.emplace();
      plate.rigid->force[1] = -1.0;
      data.boundaries.push_back(plate);
      break;
    }
    default:
      data.boundaries.push_back(loaded<2>("top", any(0.05), -0.4));
  }
  return data;
}

}  // namespace tribound::test
