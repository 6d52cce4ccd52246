/// @file two_bodies_rates_test.cpp
/// Smooth solutions of two bodies on non-matching meshes: error and bound fall like h^p, the loss of traction
/// between the meshes like h^(p + 1/2). Prints them, with the effectivity of the bound.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "verification/manufactured.h"

namespace tribound::test
{

namespace
{

/// A smooth u of both bodies together: the sides of the interface y = 0 stay together, without shear if u is
/// even in y. The solution of the lower body is u / stiffness.
struct SmoothPair
{
  std::string name;
  problem::ContactLaw law;
  double stiffness;  ///< E of the lower body; E of the upper one is 1
  std::array<std::string, 2> u;
  std::array<std::string, 4> gradient;
  std::array<std::string, 2> divergence_slope;  ///< of div u
  std::array<std::string, 2> laplacian;
};

/// Pressed everywhere, and sheared by less than friction can hold.
SmoothPair sheared(std::string name, problem::ContactLaw law)
{
  return {.name = std::move(name),
          .law = std::move(law),
          .stiffness = 1,
          .u = {"0.02*sin(1.5*x + y)", "0.02*cos(x - 1.3*y) - 0.1*y"},
          .gradient = {"0.03*cos(1.5*x + y)", "0.02*cos(1.5*x + y)", "-0.02*sin(x - 1.3*y)",
                       "0.026*sin(x - 1.3*y) - 0.1"},
          .divergence_slope = {"0.026*cos(x - 1.3*y) - 0.045*sin(1.5*x + y)",
                               "-0.03*sin(1.5*x + y) - 0.0338*cos(x - 1.3*y)"},
          .laplacian = {"-0.065*sin(1.5*x + y)", "-0.0538*cos(x - 1.3*y)"}};
}

/// Along y = 0 there is no shear: the softer body slides on the other one.
SmoothPair even()
{
  return {.name = "no friction",
          .law = Frictionless(),
          .stiffness = 10,
          .u = {"0.02*sin(1.5*x)*cos(y)", "0.02*cos(x)*sin(1.3*y) - 0.1*y"},
          .gradient = {"0.03*cos(1.5*x)*cos(y)", "-0.02*sin(1.5*x)*sin(y)", "-0.02*sin(x)*sin(1.3*y)",
                       "0.026*cos(x)*cos(1.3*y) - 0.1"},
          .divergence_slope = {"-0.045*sin(1.5*x)*cos(y) - 0.026*sin(x)*cos(1.3*y)",
                               "-0.03*cos(1.5*x)*sin(y) - 0.0338*cos(x)*sin(1.3*y)"},
          .laplacian = {"-0.065*sin(1.5*x)*cos(y)", "-0.0538*cos(x)*sin(1.3*y)"}};
}

constexpr double nu = 0.3;

template <std::size_t n>
std::array<std::string, n> scaled(std::array<std::string, n> texts, double factor)
{
  for (std::string& text : texts) text = fmt::format("{}*({})", factor, text);
  return texts;
}

/// The problem with 4 n and 3 n squares along the interface.
DiscreteProblem<2> discrete(const SmoothPair& pair_of_bodies, int p, int n)
{
  mesh::MeshData<2> data =
      side_by_side(box<2>({0, 0}, {2, 1}, {4 * n, 2 * n}), box<2>({0, -1}, {2, 0}, {3 * n, 2 * n}), "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  const problem::Material upper = lame(1, nu);
  ProblemData<2> problem{.material = upper, .pairs = {pair<2>("bottom", "top_below", pair_of_bodies.law)}};
  for (int a = 0; a < 2; ++a)  // f = -(lambda + mu) grad div u - mu laplace u is the same in both
    problem.body_force[a] =
        formula(fmt::format("-{}*({}) - {}*({})", upper.lambda + upper.mu, pair_of_bodies.divergence_slope[a],
                            upper.mu, pair_of_bodies.laplacian[a]));
  problem.regions = {{.name = "box_below",
                      .material = lame(pair_of_bodies.stiffness, nu),
                      .body_force = problem.body_force}};
  const auto below = scaled(pair_of_bodies.u, 1 / pair_of_bodies.stiffness);
  for (const std::string side : side_names<2>)
  {
    if (side != "bottom")
      problem.boundaries.push_back(
          fixed<2>(side, formula(pair_of_bodies.u[0]), formula(pair_of_bodies.u[1])));
    if (side != "top")
      problem.boundaries.push_back(fixed<2>(side + "_below", formula(below[0]), formula(below[1])));
  }
  return {std::move(data), problem, {.degree = p, .newton = {.tolerance = 1e-11}}};
}

/// Quantities that fall with h.
struct Figures
{
  double error, bound, mor;
};

Figures figures(const SmoothPair& pair_of_bodies, const DiscreteProblem<2>& c, bool with_dual_norm)
{
  const solve::NewtonResult<2> newton = c.solve();
  EXPECT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  const double share = 1 / pair_of_bodies.stiffness;
  const std::vector<ExactField<2>> exact = {
      ExactField<2>(pair_of_bodies.u, pair_of_bodies.gradient),
      ExactField<2>(scaled(pair_of_bodies.u, share), scaled(pair_of_bodies.gradient, share))};
  const certify::Estimate bound =
      certify::estimate<2>(c.form, newton.u, certify::equilibrate<2>(c.form, newton.u, newton.traction));
  const Figures result{energy_error<2>(c, newton.u, exact).error, bound.total_sharp, bound.global.mor};
  if (!with_dual_norm) return result;
  certify::DualNorm<2> dual_norm(c.form, {.refinements = 1, .degree = c.space.degree() + 2});
  const double effectivity = result.bound / dual_norm(newton.u);
  fmt::print("effectivity {:.3f}\n", effectivity);
  EXPECT_GE(effectivity, 1);
  EXPECT_LE(effectivity, 1.35);
  return result;
}

class TwoBodiesRates : public ::testing::TestWithParam<int>
{
};

TEST_P(TwoBodiesRates, OfErrorBoundAndTransfer)
{
  const int p = GetParam();
  for (const SmoothPair& pair_of_bodies : {sheared("tied", Tied()), sheared("Coulomb", Coulomb(0.5)), even()})
  {
    SCOPED_TRACE(pair_of_bodies.name);
    fmt::print("{}, p = {}\n{:>4} {:>12} {:>6} {:>12} {:>6} {:>12} {:>6}\n", pair_of_bodies.name, p, "n",
               "error", "rate", "bound", "rate", "mor", "rate");
    Figures last{};
    Figures rate{};
    for (const int n : {2, 4, 8})
    {
      const Figures now = figures(pair_of_bodies, discrete(pair_of_bodies, p, n), n == 4);
      if (last.error > 0)
        rate = {std::log2(last.error / now.error), std::log2(last.bound / now.bound),
                std::log2(last.mor / now.mor)};
      fmt::print("{:>4} {:>12.4e} {:>6.2f} {:>12.4e} {:>6.2f} {:>12.4e} {:>6.2f}\n", n, now.error, rate.error,
                 now.bound, rate.bound, now.mor, rate.mor);
      last = now;
    }
    EXPECT_NEAR(rate.error, p, 0.1);
    EXPECT_NEAR(rate.bound, p, 0.1);
    EXPECT_NEAR(rate.mor, p + 0.5, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, TwoBodiesRates, ::testing::Range(1, 4));

}  // namespace

}  // namespace tribound::test
