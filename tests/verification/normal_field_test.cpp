/// @file normal_field_test.cpp
/// Contact along a varying direction N(x): the form, the identities and the bound, against rigid obstacles
/// and between bodies.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/contact_tangent.h"
#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/contact_geometry.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/mesh/refine.h"
#include "tribound/problem/surface.h"
#include "verification/arched_block.h"

namespace tribound::test
{

namespace
{

/// A constant direction changes nothing: the facets' normals given as a constant change no digit.
TEST(NormalField, TheNormalOfTheFacetsGivenIsTheNormalOfTheFacets)
{
  for (const problem::ContactLaw& law : laws())
  {
    ProblemData<2> data = pressed_on<2>(problem::Contact(law, formula("0.002 + 0.01*x^2")));
    const auto numbers = [&]
    {
      const DiscreteProblem<2> c(block<2>({6, 3}), data, {.degree = 2});
      const solve::NewtonResult<2> newton = c.solve();
      const certify::Estimate bound =
          certify::estimate<2>(c.form, newton.u, certify::equilibrate<2>(c.form, newton.u, newton.traction));
      std::vector<double> result = newton.u;
      for (const double value : {bound.total_sharp, bound.global.cnt, bound.global.frc, bound.global.lin2n})
        result.push_back(value);
      return result;
    };
    const std::vector<double> before = numbers();
    const problem::Field down(-1.0);
    data.boundaries.back().contact->normal = problem::NormalField({0.0, down});
    EXPECT_EQ(numbers(), before);
    // As a formula it takes another path in the code, with the same result up to rounding.
    data.boundaries.back().contact->normal =
        problem::NormalField({formula("x - x + 0"), formula("-1 + 0*(x - x)")});
    const std::vector<double> varying = numbers();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(varying[i], before[i], 1e-9);
  }
}

struct Seen
{
  double least = HUGE_VAL;
  double most = 0;
};

/// At iterates 1, 2 and the last: identities, and the bound above the dual norm. Also the tangent, at a
/// random point near the solution.
template <int dim>
void expect_certified(const DiscreteProblem<dim>& c, const std::string& name, Seen& seen)
{
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = dim == 2 ? 2 : 1, .degree = c.space.degree() + 2});
  const certify::Estimator<dim> estimator(c.form, certify::ContactRule::resolved);
  bool converged = false;
  const auto check = [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    if (!iterate.converged && iterate.step.step > 2) return false;
    converged = converged || iterate.converged;
    const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, iterate.u(), iterate.traction);
    EXPECT_LE(certify::check_identities<dim>(c.form, iterate.traction, stress).largest(), 1e-9) << name;
    const double eta = estimator(iterate.u(), stress).total_sharp;
    const double below = dual_norm(iterate.u());
    EXPECT_GE(eta, below) << name << ", step " << iterate.step.step;
    if (iterate.converged)
    {
      seen.least = std::min(seen.least, eta / below);
      seen.most = std::max(seen.most, eta / below);
    }
    return false;
  };
  const solve::NewtonResult<dim> newton = c.solve(0, check);
  EXPECT_TRUE(converged) << name;
  expect_contact_tangent(c.form, sum(newton.u, 1, random_free_vector(c.form.constraints(), 1e-3, 1)), 1e-7);
}

/// Each obstacle with each degree, under laws in rotation.
TEST(NormalField, ObstaclesAreCertifiedIn2D)
{
  Seen seen;
  const auto all = obstacles(2);
  for (const int p : {1, 2, 3})
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      const problem::ContactLaw& law = laws()[(i + p) % laws().size()];
      expect_certified<2>({arched_block<2>(p == 3 ? 2 : 3),
                           pressed_on<2>(contact_with(all[i].second, law, 2)),
                           {.degree = p}},
                          fmt::format("{}, p = {}, {}", all[i].first, p, problem::name(law)), seen);
    }
  fmt::print("obstacles in 2D: {:.3f} to {:.3f}\n", seen.least, seen.most);
}

TEST(NormalField, ObstaclesAreCertifiedIn3D)
{
  Seen seen;
  expect_certified<3>({arched_block<3>(1),
                       pressed_on<3>(contact_with(obstacles(3)[1].second, Coulomb(0.3), 3)),
                       {.degree = 1}},
                      "punch in 3D, Coulomb", seen);
  fmt::print("obstacles in 3D: {:.3f} to {:.3f}\n", seen.least, seen.most);
}

TEST(NormalField, PairsAreCertified)
{
  Seen seen;
  for (const int p : {1, 2, 3})
  {
    const problem::ContactLaw& law = laws()[p - 1];
    auto [data, problem] = pair_on_arc<2>(p == 3 ? 2 : 3, law);
    expect_certified<2>({std::move(data), problem, {.degree = p}},
                        fmt::format("pair, p = {}, {}", p, problem::name(law)), seen);
  }
  fmt::print("pairs: {:.3f} to {:.3f}\n", seen.least, seen.most);
}

/// The gap is the distance of the meshes along the direction of contact.
TEST(NormalField, PairsMayKeepTheGapOfTheMeshes)
{
  auto [data, problem] = pair_on_arc<2>(4, Coulomb(0.3));
  problem.pairs[0].contact.gap.reset();
  Seen seen;
  const DiscreteProblem<2> c(std::move(data), problem, {.degree = 2});
  expect_certified<2>(c, "gap of the meshes", seen);
  for (const contact::ContactSegment<2>& segment : c.form.segments())
  {
    const contact::SimplexMap<1, 2> map = contact::simplex_map(c.mesh, segment.slave);
    const contact::SimplexMap<1, 2> opposite = contact::simplex_map(c.mesh, *segment.master);
    const Point<1> s(0.3);
    const Point<2> n = segment.normal_at(map(s));
    EXPECT_NEAR(segment.gap(s, map(s), n), (opposite(s) - map(s)).dot(n), 1e-14);
  }
}

/// The largest pressure of the arc on the floor, with its twelve facets refined uniformly.
double pressure_on_arc(const problem::Contact& contact, int refinements)
{
  const mesh::Mesh<2> mesh(mapped<2>(box<2>(Point<2>(-0.5, 0), Point<2>(0.5, 1), {12, 12}),
                                     [](Point<2> x) -> Point<2>
                                     {
                                       x[1] += (1 - x[1]) * (1 - std::sqrt(1 - x[0] * x[0]));
                                       return x;
                                     }));
  if (refinements == 0) return largest_pressure(contact, mesh);
  return largest_pressure(contact, mesh::refine_uniformly(mesh, refinements).mesh);
}

/// The pressure peaks of the polygon grow with refinement. With the obstacle's direction and the gap of the
/// true shape there are none, and the pressure is that of a flat side with the curvature in the gap.
TEST(NormalField, ThePressureHasNoPeaksOfThePolygon)
{
  const problem::Contact polygon(Frictionless(), formula("y"));
  const problem::Contact shape = contact_with(obstacles(2)[0].second, Frictionless(), 2);
  std::vector<double> of_polygon;
  std::vector<double> of_shape;
  for (int level = 0; level <= 3; ++level)
  {
    of_polygon.push_back(pressure_on_arc(polygon, level));
    of_shape.push_back(pressure_on_arc(shape, level));
    fmt::print("level {}: {:.4f} {:.4f}\n", level, of_polygon.back(), of_shape.back());
  }
  EXPECT_GT(of_polygon[3], 1.1 * of_polygon[1]);
  EXPECT_NEAR(of_shape[3], of_shape[2], 0.01 * of_shape[3]);
  EXPECT_GT(of_polygon[3], 1.5 * of_shape[3]);
}

TEST(NormalField, TheCertificateKnowsThePolygon)
{
  const problem::Contact shape = contact_with(obstacles(2)[1].second, Frictionless(), 2);
  const int n = 4;
  const DiscreteProblem<2> c(arched_block<2>(n), pressed_on<2>(shape));
  const certify::ContactGeometryFacts facts = certify::contact_geometry(c.form);
  EXPECT_TRUE(facts.has_shape);
  EXPECT_TRUE(facts.has_direction);
  double sagitta = 0;
  double turn = 0;
  std::vector<double> angles;
  for (int i = 0; i <= n; ++i) angles.push_back(std::asin(-0.5 + static_cast<double>(i) / n));
  for (int i = 0; i < n; ++i) sagitta = std::max(sagitta, 1 - std::cos((angles[i + 1] - angles[i]) / 2));
  for (int i = 1; i < n; ++i) turn = std::max(turn, (angles[i + 1] - angles[i - 1]) / 2);
  EXPECT_NEAR(facts.sagitta, sagitta, 1e-12);
  EXPECT_NEAR(facts.turn, turn * 180 / std::numbers::pi, 1e-9);
  EXPECT_LE(facts.jump, 1e-6);
}

}  // namespace

}  // namespace tribound::test
