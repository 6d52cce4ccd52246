/// @file hidden_data_test.cpp
/// The bound is above the dual norm of the residual for data that a rule of fixed order does not see: strips,
/// steps, spikes and oscillations narrower than the distance of its points. The dual norm is computed with
/// loads that share no code with the program: C++ functions, integrated by brute force.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

namespace
{

using Function = std::function<double(double)>;

/// A function of one coordinate, as a formula and as a C++ function, with the places of its jumps and kinks.
struct Profile
{
  std::string text;
  Function value;
  std::vector<double> breaks;
};

class Random
{
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double a, double b) { return a + (b - a) * std::ldexp(static_cast<double>(engine_()), -32); }
  /// A size between a and b, log-uniform.
  double size(double a, double b) { return std::exp(between(std::log(a), std::log(b))); }
  int of(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 engine_;
};

/// A profile in `variable`, which runs from 0 to `length`, with values between 0 and `top`.
Profile random_profile(Random& random, char variable, double length, double top, double narrowest)
{
  const double v = random.between(0.1, 1) * top;
  const double a = random.between(0, length);
  const int kind = random.of(6);
  const bool cut = kind == 0 || kind == 3;  // by the integration by brute force
  const double w = random.size(cut ? narrowest : std::max(narrowest, 5e-3), 0.4);
  const double b = a + w;
  switch (kind)
  {
    case 0:
      return {fmt::format("{0} > {1:.17g} && {0} < {2:.17g} ? {3:.17g} : 0", variable, a, b, v),
              [=](double x) { return x > a && x < b ? v : 0; },
              {a, b}};
    case 1:
      return {fmt::format("{3:.17g}*exp(-(({0}-{1:.17g})/{2:.17g})^2)", variable, a, w, v),
              [=](double x) { return v * std::exp(-std::pow((x - a) / w, 2)); },
              {a}};
    case 2:
      return {fmt::format("{2:.17g}*sin({0}/{1:.17g})^2", variable, w, v),
              [=](double x) { return v * std::pow(std::sin(x / w), 2); },
              {}};
    case 3:
      return {fmt::format("{3:.17g}*max(0, 1-abs({0}-{1:.17g})/{2:.17g})", variable, a, w, v),
              [=](double x) { return v * std::max(0.0, 1 - std::abs(x - a) / w); },
              {a - w, a, a + w}};
    case 4:
      return {fmt::format("{2:.17g}*(1+sign({0}-{1:.17g}))/2", variable, a, v),
              [=](double x) { return x > a ? v : 0; },
              {a}};
    default:
      return {fmt::format("{2:.17g}*abs(rint({0}/{1:.17g})-{0}/{1:.17g})", variable, w, v),
              [=](double x) { return v * std::abs(std::nearbyint(x / w) - x / w); },
              {}};
  }
}

/// Loads by brute force in the space of the dual norm: f_y on the body, g_y on the top, both functions of x.
class BruteForce
{
 public:
  explicit BruteForce(const fem::LagrangeSpace<2>& space) : space_(space) {}

  /// Every cell is cut into 4^5 parts.
  void add_body(const Function& f, std::vector<double>& load) const
  {
    constexpr int cuts = 32;
    constexpr double h = 1.0 / cuts;
    std::vector<Point<2>> points;
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j)
      {
        points.push_back({(i + 1.0 / 3) * h, (j + 1.0 / 3) * h});
        if (i + j < cuts - 1) points.push_back({(i + 2.0 / 3) * h, (j + 2.0 / 3) * h});
      }
    const fem::Tabulation<2> table = space_.basis().tabulate(points);
    for (Index c = 0; c < space_.mesh().n_cells(); ++c)
    {
      const mesh::CellMap<2> map = mesh::cell_map(space_.mesh(), c);
      for (std::size_t q = 0; q < points.size(); ++q)
      {
        const double weighted = map.det * h * h / 2 * f(map(points[q])[0]);
        const auto phi = table.values_at(static_cast<int>(q));
        for (std::size_t i = 0; i < phi.size(); ++i)
          load[2 * space_.cell_nodes(c)[i] + 1] += weighted * phi[i];
      }
    }
  }

  /// Facets of boundary `tag`, cut at the breaks and into 32 parts.
  void add_traction(int tag, const Profile& g, std::vector<double>& load) const
  {
    const fem::Quadrature<1> rule = fem::quadrature<1>(2 * space_.degree() + 4);
    for (const mesh::BoundaryFacet& facet : space_.mesh().boundary())
    {
      if (facet.tag != tag) continue;
      const mesh::CellMap<2> map = mesh::cell_map(space_.mesh(), facet.cell);
      const auto at = [&](double s) { return map(mesh::facet_to_cell<2>(facet.local, Point<1>(s))); };
      const double measure = mesh::facet_geometry(space_.mesh(), facet.cell, facet.local).measure;
      std::vector<double> ends;
      for (int i = 0; i <= 32; ++i) ends.push_back(i / 32.0);
      for (const double b : g.breaks)
      {
        const double s = (b - at(0)[0]) / (at(1)[0] - at(0)[0]);
        if (s > 0 && s < 1) ends.push_back(s);
      }
      std::ranges::sort(ends);
      std::vector<Point<2>> points;
      std::vector<double> weighted;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k)
        for (int q = 0; q < rule.size(); ++q)
        {
          const double s = ends[k] + (ends[k + 1] - ends[k]) * rule.points[q][0];
          points.push_back(mesh::facet_to_cell<2>(facet.local, Point<1>(s)));
          weighted.push_back((ends[k + 1] - ends[k]) * rule.weights[q] * measure * g.value(at(s)[0]));
        }
      const fem::Tabulation<2> table = space_.basis().tabulate(points);
      for (std::size_t q = 0; q < points.size(); ++q)
      {
        const auto phi = table.values_at(static_cast<int>(q));
        for (std::size_t i = 0; i < phi.size(); ++i)
          load[2 * space_.cell_nodes(facet.cell)[i] + 1] += weighted[q] * phi[i];
      }
    }
  }

 private:
  const fem::LagrangeSpace<2>& space_;
};

/// A block on a floor, held at the left, with a body force and a load from above; one datum is hard to see.
struct RandomCase
{
  ProblemData<2> data;
  adapt::Method method;
  Profile body;      ///< f_y
  Profile traction;  ///< g_y on the top
};

RandomCase random_case(Random& random)
{
  const Profile zero{"0", [](double) { return 0.0; }, {}};
  RandomCase c{{}, {.degree = 1 + random.of(3)}, zero, zero};
  problem::Contact contact((Frictionless()));
  const int hard = random.of(4);
  if (hard == 0) c.body = random_profile(random, 'x', 2, -1, 0.03);
  if (hard == 1 || hard > 2) c.traction = random_profile(random, 'x', 2, -1, 1e-4);
  if (hard == 2)
  {
    c.traction = {"-0.1", [](double) { return -0.1; }, {}};
    contact.gap = formula(random_profile(random, 'x', 2, 0.1, 0.02).text);
  }
  const int law = random.of(3);
  if (law == 1)
    contact.law =
        Tresca(hard == 3 ? formula(random_profile(random, 'x', 2, 0.3, 0.02).text) : problem::Field(0.03));
  if (law == 2) contact.law = Coulomb(random.between(0, 0.6));
  c.data = {.boundaries = {clamped<2>("left"), loaded<2>("top", 0, formula(c.traction.text)),
                           obstacle<2>("bottom", contact)},
            .body_force = {0, formula(c.body.text)}};
  c.method.newton.max_steps = 1 + random.of(4);
  return c;
}

/// Bound over dual norm after a few steps of Newton's method.
double random_effectivity(Random& random, const std::string& seed)
{
  const RandomCase c = random_case(random);
  const int nx = 2 + random.of(3);
  const DiscreteProblem<2> problem(block<2>({nx, 1 + random.of(2)}), c.data, c.method);
  const solve::NewtonResult<2> newton = problem.solve();
  const certify::Estimate eta = certify::estimate<2>(
      problem.form, newton.u, certify::equilibrate<2>(problem.form, newton.u, newton.traction));

  certify::DualNorm<2> dual_norm(problem.form, {.refinements = 1, .degree = c.method.degree + 1});
  const fem::LagrangeSpace<2>& space = dual_norm.space();
  std::vector<double> exact(space.n_dofs(), 0.0);
  const BruteForce brute(space);
  if (c.body.text != "0") brute.add_body(c.body.value, exact);
  const auto names = problem.mesh.boundary_names();
  const int top = static_cast<int>(std::ranges::find(names, "top") - names.begin());
  if (c.traction.text != "0") brute.add_traction(top, c.traction, exact);
  const double below = dual_norm.of(dual_norm.residual(newton.u, exact));
  const std::optional<double> found = certify::effectivity(
      eta.total_sharp, below, contact::stress_norms(problem.problem, problem.space, newton.u));
  if (!found) return 1;  // no load reaches the body
  EXPECT_GE(*found, 1) << seed;
  return *found;
}

TEST(HiddenData, TheBoundIsAboveTheDualNormIn500RandomCases)
{
  constexpr int n_cases = 500;
  std::vector<double> found;
  for (int i = 0; i < n_cases; ++i)
  {
    Random random(static_cast<unsigned>(i));
    found.push_back(random_effectivity(random, fmt::format("case {}", i)));
  }
  std::ranges::sort(found);
  std::cout << fmt::format("effectivities: smallest {:.4f}, median {:.4f}, largest {:.4f}\n", found.front(),
                           found[n_cases / 2], found.back());
  EXPECT_LE(found[n_cases / 2], 4);  // mostly early iterates on coarse, stretched cells
}

/// In 3D: jumps along planes in all data, on cells far larger than the regions between the planes.
TEST(HiddenData, TheBoundIsAboveTheDualNormIn3D)
{
  for (unsigned seed = 0; seed < 12; ++seed)
  {
    Random random(seed);
    const auto plane = [&]
    {
      return fmt::format("{:.3g}*x + {:.3g}*y + {:.3g}*z < {:.3g}", random.between(0, 1),
                         random.between(0, 1), random.between(0, 1), random.between(0.3, 1.2));
    };
    const double a = random.between(0, 0.9);
    const std::string threshold = plane() + " ? 0.05 : 0.01";
    const std::string strip = fmt::format("x > {:.3g} && x < {:.3g} ? 1 : 0", a, a + random.size(1e-3, 0.2));
    const std::string weight = plane() + " ? -0.2 : 0";
    SCOPED_TRACE(fmt::format("seed {}: {}, {}, {}", seed, threshold, strip, weight));
    const DiscreteProblem<3> c(box<3>({0, 0, 0}, {1, 1, 1}, {2, 1, 1}),
                               {.boundaries = {clamped<3>("left"), pressed<3>("top", formula(strip)),
                                               obstacle<3>("bottom", Tresca(formula(threshold)))},
                                .body_force = {0, formula(weight), 0}},
                               {.degree = 1 + static_cast<int>(seed % 2)});
    const solve::NewtonResult<3> newton = c.solve();
    const certify::Estimate eta =
        certify::estimate<3>(c.form, newton.u, certify::equilibrate<3>(c.form, newton.u, newton.traction));
    EXPECT_LE(eta.global.quad, 1e-12);  // planes are cut exactly
    certify::DualNorm<3> dual_norm(c.form, {.refinements = 1, .degree = 3});
    EXPECT_GE(eta.total_sharp, dual_norm(newton.u));
  }
}

/// Strips between the points of the rule used to be missed entirely: stress 0, bound 0.
TEST(HiddenData, ANarrowStripIsSeen)
{
  const DiscreteProblem<2> c(
      block<2>({4, 2}),
      {.boundaries = {clamped<2>("left"), loaded<2>("top", 0, formula("x > 0.26 && x < 0.32 ? -1 : 0")),
                      obstacle<2>("bottom", Coulomb(0.3))}},
      {.degree = 2});
  double force = 0;
  for (std::size_t i = 1; i < c.form.load().size(); i += 2) force += c.form.load()[i];
  EXPECT_NEAR(force, -0.06, 1e-15);
  EXPECT_EQ(c.form.data().effort().formulas, 4U);
  EXPECT_EQ(c.form.data().effort().subdivided, 1U);
  EXPECT_EQ(c.form.data().effort().parts, 3U);
}

}  // namespace

}  // namespace tribound::test
