/// @file energy_meridian_test.cpp
/// The bound of the energy-norm error of bodies of revolution: above the distance from much richer solutions
/// in random cases on and off the axis, at every iterate, and with the laws and loads that it has.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/meridian_problem.h"
#include "tribound/certify/energy/balanced_traction.h"
#include "verification/energy_effectivity.h"

namespace tribound::test
{

namespace
{

certify::EnergyBound bound_of(const MeridianProblem& c, std::span<const double> u)
{
  return certify::EnergyEstimator<2>(c.form, c.method.solver)(u);
}

/// The threshold -mu t_h^n of the traction with which the bound was made, as a function of r on a boundary
/// that is flat.
problem::Field computed_threshold(const MeridianProblem& c, std::span<const double> u, double friction)
{
  struct Piece
  {
    double from;
    double to;
    std::vector<double> coefficients;
  };
  const certify::FreeMotions<2> motions(c.problem, c.mesh);
  const auto t_h = certify::balanced_traction<2>(c.form, motions, c.form.traction(u));
  std::vector<Piece> pieces;
  const std::size_t n = c.space.degree() + 1;
  const fem::LagrangeBasis<1> basis(c.space.degree());
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const auto map = contact::simplex_map(c.mesh, c.form.segments()[k].slave);
    Piece piece{map(Point<1>(0))[0], map(Point<1>(1))[0], std::vector<double>(n)};
    for (std::size_t j = 0; j < n; ++j)
      piece.coefficients[basis.node(static_cast<int>(j))[1]] =
          -friction * t_h->coefficients[k * n + j].dot(c.form.segments()[k].normal);
    pieces.push_back(piece);
  }
  const auto at = [pieces](double r)
  {
    for (const Piece& piece : pieces)
    {
      const double s = (r - piece.from) / (piece.to - piece.from);
      if (s < -1e-12 || s > 1 + 1e-12) continue;
      std::vector<double> b = piece.coefficients;  // de Casteljau
      for (std::size_t m = b.size() - 1; m > 0; --m)
        for (std::size_t j = 0; j < m; ++j) b[j] = (1 - s) * b[j] + s * b[j + 1];
      return std::max(0.0, b[0]);
    }
    return 0.0;
  };
  return problem::Field(
      problem::FieldFunction{.values = [at](std::span<const double> x, int dim, std::span<double> values)
                             {
                               for (std::size_t i = 0; i < values.size(); ++i) values[i] = at(x[i * dim]);
                             }});
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
double expect_bound(const RicherReference<2>& reference, std::span<const double> u,
                    const certify::EnergyBound& eta, const std::string& name)
{
  EXPECT_EQ(eta.reason, "") << name;
  EXPECT_LE(eta.cell_balance, 1e-11) << name;
  const double found = eta.bound / reference.distance(u);
  EXPECT_GE(found, 1) << name;
  return found;
}

TEST(EnergyMeridian, IsABoundInRandomCases)
{
  std::map<int, std::vector<double>> converged;
  const std::array<problem::ContactLaw, 3> laws = {Frictionless(), Tresca(formula("0.01 + 0.02*x")),
                                                   Coulomb(0.4)};
  for (unsigned seed = 0; seed < n_cases(36); ++seed)
  {
    RandomMeridian random{std::mt19937(seed)};
    const std::array<double, 3> inner_radii = {0, 0.05, 0.5};
    const double inner = seed % 2 == 0 ? 0 : inner_radii[1 + seed / 2 % 2];
    const int p = 1 + static_cast<int>(seed / 2) % 3;
    const problem::ContactLaw& law = laws[seed / 4 % 3];
    const ProblemData<2> data = random.data(inner, law);
    MeridianProblem c(random_meridian(inner, 2 + static_cast<int>(seed % 2), seed), data,
                      {.degree = p, .newton = {.tolerance = 1e-11}});
    const certify::RicherSpace richer{.refinements = 2, .degree = std::min(p + 2, fem::max_degree)};
    const bool rubs = std::holds_alternative<Coulomb>(law);
    std::unique_ptr<RicherReference<2>> reference;
    const int all_steps = c.method.newton.max_steps;
    std::string line = fmt::format("seed {}: p = {}, inner = {}, law {}", seed, p, inner, law.index());
    for (const int steps : {1, 2, all_steps})
    {
      c.method.newton.max_steps = steps;
      const std::vector<double> u = c.solve().u;
      const certify::EnergyBound eta = bound_of(c, u);
      std::optional<problem::Problem<2>> with_threshold;
      std::optional<contact::NitscheForm<2>> tresca;
      if (rubs)
      {
        EXPECT_EQ(eta.target, certify::EnergyTarget::computed_friction);
        ProblemData<2> of_tresca = data;
        of_tresca.boundaries[0].contact->law = Tresca(computed_threshold(c, u, 0.4));
        with_threshold.emplace(of_tresca.on(c.mesh).axisymmetric());
        tresca.emplace(*with_threshold, c.space, c.method.gamma_0());
      }
      if (rubs || !reference)
        reference = std::make_unique<RicherReference<2>>(rubs ? *tresca : c.form, c.method, richer);
      const double found = expect_bound(*reference, u, eta, line);
      line += fmt::format("  k = {:<2} {:.4f}", steps, found);
      if (steps == all_steps) converged[p].push_back(found);
    }
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }
  for (auto& [p, found] : converged)
  {
    std::ranges::sort(found);
    EXPECT_LE(found[found.size() / 2], 1.6) << p;
    fmt::print("p = {}: effectivity {:.3f}, {:.3f}, {:.3f}\n", p, found.front(), found[found.size() / 2],
               found.back());
  }
}

}  // namespace

}  // namespace tribound::test
