/// @file newton_test.cpp
/// The damped Newton method on the block of problem T2D converges in at most 20 steps for every friction law,
/// mesh and degree. Prints the steps.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

constexpr std::size_t most_steps = 20;

/// Steps and damped steps on the three meshes for p = 1 and 2.
void check_steps(const std::string& name, const problem::ContactLaw& law)
{
  fmt::print("{:<22}", name);
  for (const int p : {1, 2})
    for (const int ny : {4, 8, 16})
    {
      SCOPED_TRACE(fmt::format("{}, p = {}, {} x {}", name, p, 2 * ny, ny));
      const DiscreteProblem<2> c(block<2>({2 * ny, ny}), pressed_block<2>(law), {.degree = p});
      const solve::NewtonResult<2> newton = c.solve();
      EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
      EXPECT_LE(newton.steps.size(), most_steps);
      const auto damped =
          std::ranges::count_if(newton.steps, [](const solve::NewtonStep& step) { return step.damping < 1; });
      fmt::print(" {:>6} ({:>2})", newton.steps.size(), damped);
    }
  fmt::print("\n");
}

void print_header()
{
  fmt::print("{:<22}", "steps (damped)");
  for (const int p : {1, 2})
    for (const int ny : {4, 8, 16}) fmt::print(" {:>11}", fmt::format("p{} {}x{}", p, 2 * ny, ny));
  fmt::print("\n");
}

TEST(NewtonSteps, Tresca)
{
  print_header();
  for (int i = 1; i <= 10; ++i) check_steps(fmt::format("Tresca s = {:.2f}", 0.01 * i), Tresca(0.01 * i));
}

TEST(NewtonSteps, Coulomb)
{
  print_header();
  for (const double mu_F : {0.2, 0.5, 1.0})
    check_steps(fmt::format("Coulomb mu_F = {}", mu_F), Coulomb(mu_F));
}

}  // namespace

}  // namespace tribound::test
