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
#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/polynomials.h"
#include "verification/random_meridian_bound.h"

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

/// h int r (T^n - Pi T^n)^2 on a segment, Pi the projection onto P^p with the weight r, by Gauss rules of
/// high degree on 64 parts.
double distance_from_projection(const MeridianProblem& c, std::span<const double> u, std::size_t k)
{
  const contact::ContactSegment<2>& segment = c.form.segments()[k];
  const fem::Quadrature<1> rule = fem::quadrature<1>(15);
  constexpr int n_parts = 64;
  std::vector<Point<1>> points;
  for (int i = 0; i < n_parts; ++i)
    for (const Point<1>& s : rule.points) points.emplace_back((i + s[0]) / n_parts);
  const fem::Tabulation<2> table = contact::tabulate<2>(c.space.basis(), segment.slave, points);
  const auto states = c.form.contact_states(u, k, {points, &table, nullptr}, contact::WhichData::given);
  const Eigen::Index n = c.space.degree() + 1;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd theta(n, static_cast<Eigen::Index>(points.size()));
  Eigen::VectorXd weights(theta.cols());
  Eigen::VectorXd t(theta.cols());
  for (Eigen::Index q = 0; q < theta.cols(); ++q)
  {
    fem::orthonormal_values<1>(c.space.degree(), points[q],
                               std::span(theta.col(q).data(), static_cast<std::size_t>(n)));
    weights[q] = rule.weights[q % rule.size()] / n_parts * states[q].point[0];
    t[q] = states[q].traction.dot(states[q].normal);
    gram += weights[q] * theta.col(q) * theta.col(q).transpose();
    moments += weights[q] * t[q] * theta.col(q);
  }
  const Eigen::VectorXd rest = t - theta.transpose() * CholeskyFactors(gram).solve(moments);
  return segment.h * segment.det() * rest.dot(weights.asDiagonal() * rest);
}

/// The program has rules of 9 points on edges: where the state of contact changes inside one, only p = 2 has
/// the same discrete problem. For p = 1 its stress is in equilibrium up to its osc, which should vanish.
TEST(Axisymmetric, ReferenceNumbers)
{
  std::ifstream file(AXISYMMETRY_REFERENCE);
  for (const nlohmann::json& expected : nlohmann::json::parse(file))
  {
    const double inner = expected["r0"];
    const int p = expected["p"];
    const int n = expected["n"];
    const bool rubs = expected["law"] == "coulomb";
    if (rubs && p != 2) continue;
    const problem::ContactLaw law = rubs ? problem::ContactLaw(Coulomb(0.3)) : Frictionless();
    const MeridianProblem c(box<2>({inner, 0}, {1, 1}, {n, n}), reference_problem(inner, law),
                            {.degree = p, .gamma0 = 10, .newton = {.tolerance = 1e-13}});
    const std::string name =
        fmt::format("{}, p = {}, n = {}, inner = {}", rubs ? "coulomb" : "none", p, n, inner);
    const solve::NewtonResult<2> solved = c.solve();
    const auto near = [&](double value, double number, double digits, const char* key)
    { EXPECT_NEAR(value, number, digits * std::abs(number)) << name << ", " << key; };
    near(contact::stress_norms<2>(c.problem, c.space, solved.u).energy, expected["energy"], 1e-9, "energy");
    Point<2> force = Point<2>::Zero();
    for (std::size_t i = 0; i < solved.traction.size(); ++i)
      force += c.form.contact_points()[i].weight * solved.traction[i];
    near(force[1], -expected["normal"].get<double>(), 1e-9, "normal");
    EXPECT_NEAR(force[0], expected["tangential"].get<double>(), 1e-11) << name;

    const certify::Stress<2> stress = certify::equilibrate<2>(c.form, solved.u, solved.traction);
    const certify::Estimate bound = certify::estimate<2>(
        c.form, solved.u, stress, rubs ? certify::ContactRule::reference : certify::ContactRule::resolved);
    EXPECT_LE(bound.global.osc, 1e-14) << name;  // f is constant
    EXPECT_GE(bound.total_sharp, expected["dual"].get<double>()) << name;
    if (p == 1) continue;
    const nlohmann::json& parts = expected["bound_parts"];
    near(bound.global.str, parts["str"], 1e-6, "str");
    near(bound.global.cnt, parts["cnt"], 1e-6, "cnt");
    EXPECT_NEAR(bound.global.frc, parts["frc"].get<double>(), 1e-6 * bound.global.str) << name << ", frc";
  }
}

/// cnt and frc by their definition on segments that are cut into many parts, where nothing changes its state.
TEST(Axisymmetric, ContactTermsAreThoseOfTheirDefinition)
{
  for (const double inner : {0.0, 0.5})
    for (const int p : {1, 2, 3})
    {
      const MeridianProblem c(box<2>({inner, 0}, {1, 1}, {3, 3}), reference_problem(inner, Frictionless()),
                              {.degree = p, .newton = {.tolerance = 1e-12}});
      const solve::NewtonResult<2> solved = c.solve();
      const certify::Estimate bound =
          certify::estimate<2>(c.form, solved.u, certify::equilibrate<2>(c.form, solved.u, solved.traction));
      double squares = 0;
      for (std::size_t k = 0; k < c.form.segments().size(); ++k)
        squares += distance_from_projection(c, solved.u, k);
      EXPECT_NEAR(bound.global.cnt, std::sqrt(squares), 1e-9 * bound.global.cnt) << inner << ", p = " << p;
    }
}

/// A law, loads and a support at random.
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
      random() % 2 == 0 ? loaded<2>("top", linear(0.05), -0.4)
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
  expect_above_dual_norm_of_random(random_problem,
                                   [](const BoundedMeridian& found)
                                   {
                                     // beside it cnt and frc can be as large, where contact ends inside a
                                     // facet
                                     EXPECT_LE(found.eta.global.str, 1.2 * found.below) << found.name;
                                   });
}

/// The outer one of two rings is pressed onto the inner one.
ProblemData<2> random_rings(std::mt19937& random)
{
  std::uniform_real_distribution<double> number(-1, 1);
  const std::vector<problem::ContactLaw> laws = {Frictionless(), Tresca(0.005), Coulomb(0.3), Tied()};
  const problem::ContactLaw& law = laws[random() % laws.size()];
  ProblemData<2> data{
      .boundaries = {loaded<2>("right_outer", formula("-0.03 + 0.02*y"), 0.01 * number(random)),
                     loaded<2>("top", 0, -0.02), fixed<2>("bottom", free, 0.0),
                     fixed<2>("bottom_outer", free, 0.0)},
      .material = lame(1, 0.3)};
  data.pairs = {pair<2>("right", "left_outer", law)};
  if (!std::holds_alternative<Tied>(law)) data.pairs[0].contact.gap = -0.02 - 0.01 * number(random);
  return data;
}

/// Checks bound and identities; `sharpness`: most of the bound over the dual norm.
void expect_guaranteed(const MeridianProblem& c, bool matches, double sharpness, const std::string& name)
{
  certify::DualNorm<2> dual_norm(
      c.form, {.refinements = 2, .degree = std::min(c.method.degree + 2, fem::max_degree)});
  const solve::NewtonResult<2> newton = c.solve();
  const double below = dual_norm(newton.u);
  const certify::Stress<2> stress = certify::equilibrate<2>(c.form, newton.u, newton.traction);
  const certify::Estimate eta = certify::estimate<2>(c.form, newton.u, stress);
  const std::string line = fmt::format("{}: p = {}  {:.4f}", name, c.method.degree, eta.total_sharp / below);
  EXPECT_GE(eta.total_sharp, below) << line;
  EXPECT_LE(eta.total_sharp, sharpness * below) << line;
  EXPECT_EQ(eta.global.mor == 0, matches) << line;
  EXPECT_LE(certify::check_identities<2>(c.form, newton.traction, stress,
                                         certify::Estimator<2>(c.form).algebraic_remainder(newton.u, stress))
                .largest(),
            1e-11)
      << line;
  std::cout << line << std::endl;
}

/// `n_outer`: of the outer ring, 0: as the inner one has.
void expect_guaranteed_of_rings(unsigned seed, int n_outer, double sharpness)
{
  std::mt19937 random(100 + seed);
  const double inner = seed % 2 == 0 ? 0 : 0.2;
  const int n = 2 + static_cast<int>(random() % 2);
  const auto bend = [&](const Point<2>& x) -> Point<2>  // facets of both sides still match
  {
    return {x[0], x[1] + 0.1 * std::sin(3 * x[0]) * x[1] * (1 - x[1])};
  };
  const int m = n_outer > 0 ? n_outer : n;
  mesh::MeshData<2> data =
      side_by_side(box<2>({inner, 0}, {0.6, 1}, {n, n}), box<2>({0.6, 0}, {1, 1}, {m, m}), "_outer");
  data.interfaces.push_back({{{{"right"}, {"left_outer"}}}});
  const MeridianProblem c(renumbered(mapped(std::move(data), bend), seed), random_rings(random),
                          {.degree = 1 + static_cast<int>(seed / 2) % 3, .newton = {.tolerance = 1e-11}});
  expect_guaranteed(c, n_outer == 0, sharpness, fmt::format("seed {}, rings, inner = {}", seed, inner));
}

/// A disc on another one, in contact up to the axis or to a hole.
void expect_guaranteed_of_discs(unsigned seed)
{
  std::mt19937 random(300 + seed);
  std::uniform_real_distribution<double> number(-1, 1);
  const double inner = seed % 2 == 0 ? 0 : 0.2;
  const std::vector<problem::ContactLaw> laws = {Frictionless(), Tresca(0.005), Coulomb(0.3), Tied()};
  mesh::MeshData<2> data = side_by_side(random_meridian(inner, 3 + static_cast<int>(random() % 2), seed),
                                        box<2>({inner, -1}, {1, 0}, {2, 2}), "_below");
  data.interfaces.push_back({{{{"bottom"}, {"top_below"}}}});
  ProblemData<2> discs{
      .boundaries = {loaded<2>("top", 0.01 * number(random), formula("-0.1 + 0.05*x")),
                     loaded<2>("right", 0.02 * number(random), 0), fixed<2>("bottom_below", free, 0.0)},
      .material = lame(1, 0.3)};
  discs.pairs = {pair<2>("bottom", "top_below", laws[random() % laws.size()])};
  const MeridianProblem c(std::move(data), discs,
                          {.degree = 1 + static_cast<int>(seed / 2) % 3, .newton = {.tolerance = 1e-11}});
  expect_guaranteed(c, false, 3, fmt::format("seed {}, discs, inner = {}", seed, inner));
}

TEST(Axisymmetric, BoundIsNotBelowTheDualNormOfTwoBodies)
{
  for (unsigned seed = 0; seed < n_cases(8); ++seed) expect_guaranteed_of_rings(seed, 0, 1.3);
}

TEST(Axisymmetric, BoundIsNotBelowTheDualNormWhereMeshesDoNotMatch)
{
  for (unsigned seed = 0; seed < n_cases(8); ++seed)
  {
    expect_guaranteed_of_rings(seed, 4 + static_cast<int>(seed % 2), 3);
    expect_guaranteed_of_discs(seed);
  }
}

}  // namespace

}  // namespace tribound::test
