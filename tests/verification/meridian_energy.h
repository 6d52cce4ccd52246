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
#include <vector>

#include "support/meridian_problem.h"
#include "verification/energy_effectivity.h"

namespace tribound::test
{

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

/// Every interval contains the value of a much richer solution.
inline void expect_intervals(const MeridianProblem& c, const std::vector<problem::Quantity<2>>& quantities,
                             std::span<const double> u, const std::string& name)
{
  const int p = c.space.degree();
  const RicherReference<2> reference(c.form, c.method,
                                     {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
  const certify::EnergyBound rich =
      certify::EnergyEstimator<2>(reference.form(), c.method.solver, quantities)(reference.u());
  const certify::EnergyBound bound = certify::EnergyEstimator<2>(c.form, c.method.solver, quantities)(u);
  ASSERT_EQ(bound.reason, "") << name;
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
}

}  // namespace tribound::test
