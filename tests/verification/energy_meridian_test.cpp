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
#include "verification/arched_block.h"
#include "verification/energy_effectivity.h"
#include "verification/meridian_energy.h"

namespace tribound::test
{

namespace
{

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

TEST(EnergyMeridian, IsABoundOfTwoBodies)
{
  for (unsigned seed = 0; seed < n_cases(18); ++seed)
  {
    const int p = 1 + static_cast<int>(seed / 3) % 3;
    const MeridianProblem c = rings(seed, p);
    const std::vector<double> u = c.solve().u;
    const RicherReference<2> reference(c.form, c.method,
                                       {.refinements = 2, .degree = std::min(p + 2, fem::max_degree)});
    const certify::EnergyBound eta = bound_of(c, u);
    const double found = expect_bound(reference, u, eta, fmt::format("rings {}", seed));
    EXPECT_EQ(eta.transfer > 0, seed % 3 == 2);
    EXPECT_LE(found, 5) << seed;
    fmt::print("rings {}: p = {}: {:.3f}, of transfer {:.1e} of {:.1e}\n", seed, p, found, eta.transfer,
               eta.bound);
    std::fflush(stdout);
  }
}

/// A cylinder on a round punch: directions of contact vary, also on the facet that touches the axis.
TEST(EnergyMeridian, IsABoundWhereDirectionsVary)
{
  for (const int p : {1, 2, 3})
    for (const bool is_free : {false, true})
      for (const problem::ContactLaw& law :
           {problem::ContactLaw(Frictionless()), problem::ContactLaw(Tresca(0.01))})
      {
        const problem::Surface punch = problem::sphere(point({0, -8}, 2), 8, problem::Positive::outside);
        ProblemData<2> data{
            .boundaries = {is_free ? loaded<2>("top", 0, -0.02) : fixed<2>("top", free, -0.02)},
            .material = lame(1, 0.3)};
        data.boundaries.push_back(obstacle<2>("bottom"));
        data.boundaries.back().contact = contact_with(punch, law, 2, false);
        const MeridianProblem c(random_meridian(0, 5, 1), data,
                                {.degree = p, .newton = {.tolerance = 1e-11}});
        const std::vector<double> u = c.solve().u;
        const std::string name =
            fmt::format("punch: p = {}, law {}, {}", p, law.index(), is_free ? "free" : "held");
        const certify::EnergyBound eta = bound_of(c, u);
        EXPECT_GT(eta.direction_remainder, 0) << name;
        const RicherReference<2> reference(c.form, c.method,
                                           {.refinements = 2, .degree = std::min(p + 1, fem::max_degree)});
        const double found = expect_bound(reference, u, eta, name);
        fmt::print("{}: {:.3f}\n", name, found);
        std::fflush(stdout);
      }
}

TEST(EnergyMeridian, IntervalsHoldTheValues)
{
  using problem::QuantityKind;
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
  {
    RandomMeridian random{std::mt19937(seed)};
    const double inner = seed % 2 == 0 ? 0 : 0.3;
    const int p = 1 + static_cast<int>(seed / 2) % 3;
    ProblemData<2> data =
        random.data(inner, seed % 3 == 0 ? problem::ContactLaw(Frictionless()) : Tresca(0.02));
    data.boundaries[1] = fixed<2>("top", free, -0.03);
    MeridianProblem c(random_meridian(inner, 2 + static_cast<int>(seed % 2), seed), data,
                      {.degree = p, .newton = {.tolerance = 1e-11}});
    if (seed % 4 == 3) c.method.newton.max_steps = 1;
    expect_intervals(
        c,
        {{.name = "energy"},
         {.name = "work", .kind = QuantityKind::load_work},
         {.name = "right", .kind = QuantityKind::mean_displacement, .boundary = "right", .direction = e_r},
         {.name = "below", .kind = QuantityKind::mean_displacement, .boundary = "bottom", .direction = e_r},
         {.name = "force", .kind = QuantityKind::contact_force, .boundary = "bottom", .direction = e_z},
         {.name = "across", .kind = QuantityKind::contact_force, .boundary = "bottom", .direction = e_r}},
        c.solve().u, fmt::format("seed {}", seed));
    if (seed % 3 == 2) continue;
    const MeridianProblem two = rings(seed, p);
    expect_intervals(
        two,
        {{.name = "energy"},
         {.name = "press", .kind = QuantityKind::contact_force, .boundary = "right", .direction = e_r},
         {.name = "drag", .kind = QuantityKind::contact_force, .boundary = "right", .direction = e_z},
         {.name = "outside",
          .kind = QuantityKind::mean_displacement,
          .boundary = "right_outer",
          .direction = e_r}},
        two.solve().u, fmt::format("rings {}", seed));
  }
}

}  // namespace

}  // namespace tribound::test
