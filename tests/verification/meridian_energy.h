#pragma once

/// @file meridian_energy.h
/// The energy bound of bodies of revolution and intervals of their quantities, against much richer solutions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/meridian_problem.h"
#include "verification/energy_effectivity.h"

namespace tribound::test
{

inline const Point<2> e_r(1, 0);
inline const Point<2> e_z(0, 1);

inline certify::EnergyBound bound_of(const MeridianProblem& c, std::span<const double> u)
{
  return certify::EnergyEstimator<2>(c.form, c.method.solver)(u);
}

struct RandomMeridian
{
  std::mt19937 random;

  double between(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  problem::Field linear(double size)
  {
    return formula(fmt::format("{:.6f} + {:.6f}*x + {:.6f}*y", between(-size, size), between(-size, size),
                               between(-size, size)));
  }

  /// The region of all data with a temperature and an initial stress, constant, linear, or of any other kind.
  problem::Region<2> stressed(const std::string& name, const ProblemData<2>& of)
  {
    const std::array<std::string, 8> shapes = {
        "1", "y", "x", "x*y - y^2", "x^3*y - x", "x^5", "sin(4*y + x)", "exp(2*y)*cos(x)"};
    const auto any = [&](double size)
    {
      return formula(fmt::format("{:.6f} + {:.6f}*({})", between(-size, size), between(-size, size),
                                 shapes[random() % shapes.size()]));
    };
    problem::Region<2> region{.name = name, .material = of.material, .body_force = of.body_force};
    region.material.expansion = 0.02;
    region.temperature = any(2);
    if (random() % 2 == 0)
      for (problem::Field* entry : {region.initial_stress.data(), &region.initial_stress[1],
                                    &region.initial_stress[2], &region.initial_stress_zz})
        *entry = any(0.03);
    return region;
  }

  /// Pressed onto an obstacle below, held at the top or by contact alone.
  ProblemData<2> data(double inner, const problem::ContactLaw& law)
  {
    const std::array<double, 4> ratios = {0, 0.2, 0.3, 0.45};
    ProblemData<2> result{
        .boundaries = {obstacle<2>("bottom", law, formula(fmt::format("{:.6f}*x", between(0, 0.03))))},
        .material = lame(1, ratios[random() % ratios.size()])};
    result.boundaries.push_back(random() % 2 == 0 ? loaded<2>("top", linear(0.03), -0.2)
                                                  : fixed<2>("top", free, -0.03));
    result.boundaries.push_back(loaded<2>("right", linear(0.05), linear(0.03)));
    if (inner > 0) result.boundaries.push_back(loaded<2>("left", linear(0.05), linear(0.02)));
    const auto constant = [&] { return problem::Field(between(-0.05, 0.05)); };
    result.body_force = {constant(), constant()};
    if (random() % 2 == 0) result.body_force = {linear(0.05), linear(0.05)};
    return result;
  }
};

/// bound / error of u against the solution `reference`.
inline double expect_bound(const RicherReference<2>& reference, std::span<const double> u,
                           const certify::EnergyBound& eta, const std::string& name)
{
  EXPECT_EQ(eta.reason, "") << name;
  EXPECT_LE(eta.cell_balance, 1e-11) << name;
  const double found = eta.bound / reference.distance(u);
  EXPECT_GE(found, 1) << name;
  return found;
}

/// Two rings, or a ring around a disc, that press each other; their meshes match or not. `are_stressed`: with
/// temperatures and initial stresses.
inline MeridianProblem rings(unsigned seed, int p, bool are_stressed = false)
{
  RandomMeridian random{std::mt19937(seed)};
  const double inner = seed % 2 == 0 ? 0 : 0.2;
  const int n = 2;
  const auto bend = [](const Point<2>& x) -> Point<2> {
    return {x[0], x[1] + 0.1 * std::sin(3 * x[0]) * x[1] * (1 - x[1])};
  };
  const bool matches = seed % 3 != 2;
  mesh::MeshData<2> data =
      side_by_side(mapped(box<2>({inner, 0}, {0.6, 1}, {n, n}), bend),
                   mapped(box<2>({0.6, 0}, {1, 1}, {n, matches ? n : 3}), bend), "_outer");
  data.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
  const std::array<problem::ContactLaw, 3> laws = {Frictionless(), Tresca(0.005), Tied()};
  const problem::ContactLaw& law = laws[matches ? seed / 2 % 3 : seed / 2 % 2];
  ProblemData<2> of{.boundaries = {loaded<2>("right_outer", random.linear(0.03), random.linear(0.01)),
                                   loaded<2>("top", random.linear(0.01), -0.02),
                                   fixed<2>("bottom", free, 0.0), fixed<2>("bottom_outer", free, 0.0)},
                    .material = lame(1, 0.3)};
  of.pairs = {pair<2>("right", "left_outer", law)};
  if (!std::holds_alternative<Tied>(law))
    of.pairs[0].contact.gap = problem::Field(random.between(-0.03, -0.01));
  if (are_stressed) of.regions = {random.stressed("box", of), random.stressed("box_outer", of)};
  return {renumbered(std::move(data), seed), of, {.degree = p, .newton = {.tolerance = 1e-11}}};
}

/// The bound is above the error, and every interval contains the value of a much richer solution. Returns
/// bound / error.
inline double expect_intervals(const MeridianProblem& c, const std::vector<problem::Quantity<2>>& quantities,
                               std::span<const double> u, const std::string& name)
{
  const int p = c.space.degree();
  const RicherReference<2> reference(c.form, c.method,
                                     {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
  const certify::EnergyBound rich =
      certify::EnergyEstimator<2>(reference.form(), c.method.solver, quantities)(reference.u());
  const certify::EnergyBound bound = certify::EnergyEstimator<2>(c.form, c.method.solver, quantities)(u);
  const double found = expect_bound(reference, u, bound, name);
  fmt::print("{}: {:.3f}\n", name, found);
  if (!bound.reason.empty()) return found;
  for (std::size_t i = 0; i < quantities.size(); ++i)
  {
    const certify::QuantityInterval& interval = bound.quantities[i];
    const double truth = rich.quantities[i].value;
    EXPECT_EQ(interval.reason, "") << name << ", " << interval.name;
    const double rounding = 1e-8 * std::abs(truth);  // of the richer solution
    EXPECT_LE(interval.lower, truth + rounding) << name << ", " << interval.name;
    EXPECT_GE(interval.upper, truth - rounding) << name << ", " << interval.name;
    fmt::print("{}, {}: {:.5g} in [{:.5g}, {:.5g}], u_h {:.5g} ({}) {}\n", name, interval.name, truth,
               interval.lower, interval.upper, interval.value, interval.basis, interval.note);
  }
  std::fflush(stdout);
  return found;
}

}  // namespace tribound::test
