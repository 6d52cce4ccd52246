/// @file normal_field_test.cpp
/// Contact along a direction N(x) that varies: the form, the identities and the bound, against rigid
/// obstacles and between bodies.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/contact_geometry.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/refine.h"
#include "tribound/problem/surface.h"

namespace tribound::test
{

namespace
{

constexpr double radius = 1;

/// A block of width 1 on top of the arc of the circle around (0, 1) (3D: of the cylinder along z).
template <int dim>
mesh::MeshData<dim> arched_block(int n)
{
  Point<dim> lower = Point<dim>::Zero();
  Point<dim> upper = Point<dim>::Ones();
  lower[0] = -0.5;
  upper[0] = 0.5;
  if (dim == 3) upper[dim - 1] = 1.0 / n;
  std::array<int, dim> cells;
  cells.fill(n);
  if (dim == 3) cells[dim - 1] = 1;
  return mapped<dim>(box<dim>(lower, upper, cells),
                     [](Point<dim> x) -> Point<dim>
                     {
                       x[1] += (1 - x[1]) * (radius - std::sqrt(radius * radius - x[0] * x[0]));
                       return x;
                     });
}

std::vector<double> point(std::initializer_list<double> x, int dim)
{
  return {x.begin(), x.begin() + dim};
}

/// The true lower side of the block.
problem::Surface arc(int dim)
{
  if (dim == 2) return problem::sphere(point({0, 1}, 2), radius, problem::Positive::outside);
  return problem::cylinder(point({0, 1, 0}, 3), point({0, 0, 1}, 3), radius, problem::Positive::outside);
}

/// Obstacles below the block: a floor, a round punch, a groove that is wider than the block.
std::vector<std::pair<std::string, problem::Surface>> obstacles(int dim)
{
  const auto round = [dim](double y, double r, problem::Positive side)
  {
    return dim == 2 ? problem::sphere(point({0.05, y}, 2), r, side)
                    : problem::cylinder(point({0.05, y, 0}, 3), point({0, 0, 1}, 3), r, side);
  };
  return {{"floor", problem::plane(point({0, 0, 0}, dim), point({0, 1, 0}, dim))},
          {"punch", round(-0.6, 0.6, problem::Positive::outside)},
          {"groove", round(1.3, 1.3, problem::Positive::inside)}};
}

problem::Contact contact_with(const problem::Surface& obstacle, problem::ContactLaw law, int dim,
                              bool with_shape = true)
{
  problem::ContactGeometry geometry{.obstacle = obstacle, .where = {.file = {}, .key = "contact"}};
  if (with_shape) geometry.shape = arc(dim);
  problem::Contact contact(std::move(law), problem::gap_of(geometry));
  contact.normal = problem::direction_of_obstacle(geometry);
  if (with_shape) contact.true_surface = problem::Field(arc(dim).distance, geometry.where);
  return contact;
}

/// Pressed down and to the side on top.
template <int dim>
ProblemData<dim> pressed_on(const problem::Contact& contact)
{
  ProblemData<dim> data{.boundaries = {fixed<dim>("top", 0.004, -0.02, 0.001), obstacle<dim>("bottom")},
                        .material = lame(1, 0.3)};
  data.boundaries.back().contact = contact;
  return data;
}

/// A round body on a block whose upper side is the same arc, a little flatter.
template <int dim>
std::pair<mesh::MeshData<dim>, ProblemData<dim>> pair_on_arc(int n, problem::ContactLaw law)
{
  Point<dim> lower = -Point<dim>::Ones();
  Point<dim> upper = Point<dim>::Zero();
  lower[0] = -0.6;
  upper[0] = 0.6;
  std::array<int, dim> cells;
  cells.fill(n + 1);
  if (dim == 3)
  {
    lower[dim - 1] = 0;
    upper[dim - 1] = 1.0 / n;
    cells[dim - 1] = 1;
  }
  constexpr double flatter = 1.25;
  mesh::MeshData<dim> below =
      mapped<dim>(box<dim>(lower, upper, cells),
                  [](Point<dim> x) -> Point<dim>
                  {
                    x[1] += (1 + x[1]) * (flatter - std::sqrt(flatter * flatter - x[0] * x[0]));
                    return x;
                  });
  mesh::MeshData<dim> data = side_by_side(arched_block<dim>(n), below, "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  const problem::Surface hole =
      dim == 2 ? problem::sphere(point({0, flatter}, 2), flatter, problem::Positive::inside)
               : problem::cylinder(point({0, flatter, 0}, 3), point({0, 0, 1}, 3), flatter,
                                   problem::Positive::inside);
  ProblemData<dim> problem{
      .boundaries = {fixed<dim>("top", 0.004, -0.02, 0.001), clamped<dim>("bottom_below")},
      .material = lame(1, 0.3),
      .regions = {{.name = "box_below", .material = lame(3, 0.2)}},
      .pairs = {pair<dim>("bottom", "top_below", law)}};
  problem.pairs[0].contact = contact_with(hole, law, dim);
  problem.pairs[0].pairing.direction = -Point<dim>::Unit(1);
  return {std::move(data), std::move(problem)};
}

const std::vector<problem::ContactLaw>& laws()
{
  static const std::vector<problem::ContactLaw> all = {Frictionless(), Tresca(0.004), Coulomb(0.3)};
  return all;
}

/// What does not vary is what it was: the normals of the facets given as a constant change no digit.
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
    // The same as a formula goes another way, with the same result up to rounding.
    data.boundaries.back().contact->normal =
        problem::NormalField({formula("x - x + 0"), formula("-1 + 0*(x - x)")});
    const std::vector<double> varying = numbers();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(varying[i], before[i], 1e-9);
  }
}

/// The derivative of the contact forces against differences.
template <int dim>
void expect_tangent(const contact::NitscheForm<dim>& form, std::span<const double> start)
{
  const std::vector<double> u(start.begin(), start.end());
  const std::vector<double> w = random_free_vector(form.constraints(), 1, 2);
  constexpr double step = 1e-7;
  const auto forces = [&](const std::vector<double>& at)
  {
    std::vector<double> result(form.space().n_dofs(), 0.0);
    form.add_contact_load(form.traction(at), result);
    return free_part(form.constraints(), result);
  };
  const std::vector<double> difference = sum(forces(sum(u, step, w)), -1, forces(sum(u, -step, w)));
  const algebra::Triplets tangent = form.contact_tangent(contact::Linearisation::newton, u);
  std::vector<double> product(form.space().n_dofs(), 0.0);
  for (std::size_t i = 0; i < tangent.values.size(); ++i)
    if (tangent.rows[i] >= 0 && tangent.cols[i] >= 0)
      product[tangent.rows[i]] += tangent.values[i] * w[tangent.cols[i]];
  EXPECT_GT(norm(product), 0);
  EXPECT_LE(norm(sum(product, 1 / (2 * step), difference)), 1e-6 * norm(product));
}

struct Seen
{
  double least = HUGE_VAL;
  double most = 0;
};

/// At the iterates 1 and 2 and at the last: identities, and the bound above the dual norm. The tangent at a
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
    EXPECT_LE(certify::check_identities<dim>(c.form, iterate.traction, stress).largest(c.space.degree()),
              1e-9)
        << name;
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
  expect_tangent<dim>(c.form, sum(newton.u, 1, random_free_vector(c.form.constraints(), 1e-3, 1)));
}

/// Each obstacle with each degree, under laws that change places.
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

/// The distance of the meshes, taken along the direction of contact.
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

/// cnt^2 + frc^2 of a facet, by a rule with many points, from the form's own account of single points: code
/// that shares neither rule nor enclosures with the certificate.
template <int dim>
double squares_by_hand(const DiscreteProblem<dim>& c, std::size_t k, std::span<const double> u,
                       std::span<const Point<dim>> traction, int n_parts)
{
  static_assert(dim == 2);
  const contact::ContactSegment<dim>& segment = c.form.segments()[k];
  const fem::Quadrature<1>& reference = c.form.facet_rule();
  const int p = c.space.degree();
  const int n = p + 1;
  std::vector<Point<dim>> coefficients(n, Point<dim>::Zero());
  std::vector<double> theta(n);
  for (int q = 0; q < reference.size(); ++q)
  {
    fem::orthonormal_values<1>(p, reference.points[q], theta);
    for (int i = 0; i < n; ++i)
      coefficients[i] += reference.weights[q] * theta[i] * traction[k * reference.size() + q];
  }
  double sum = 0;
  for (int part = 0; part < n_parts; ++part)
  {
    std::vector<Point<1>> points;
    for (const Point<1>& s : reference.points) points.emplace_back((part + s[0]) / n_parts);
    const contact::SegmentTables<dim> tables(c.space.basis(), std::span(&segment, 1), points);
    const auto states = c.form.contact_states(u, k, tables[0]);
    for (int q = 0; q < reference.size(); ++q)
    {
      Point<dim> difference = states[q].traction;
      fem::orthonormal_values<1>(p, points[q], theta);
      for (int i = 0; i < n; ++i) difference -= theta[i] * coefficients[i];
      sum += reference.weights[q] / n_parts * difference.squaredNorm();
    }
  }
  return segment.h * segment.measure * sum;
}

/// Whether what the certificate says of the contact terms of all facets is what there is, not less, and
/// hardly more.
void expect_terms(const DiscreteProblem<2>& c, std::span<const double> u, double more, int n_parts)
{
  const std::vector<Point<2>> traction = c.form.traction(u);
  const certify::Stress<2>::Tractions t{
      traction, std::vector<Point<2>>(traction.size(), Point<2>::Zero()), {}};
  const certify::ContactTerms<2> terms(c.form, certify::ContactRule::resolved);
  double certified = 0;
  double by_hand = 0;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const certify::ContactSquares squares = terms(static_cast<int>(k), u, t);
    certified += squares.cnt + squares.frc;
    by_hand += squares_by_hand<2>(c, k, u, traction, n_parts);
  }
  EXPECT_GE(std::sqrt(certified), std::sqrt(by_hand) * (1 - 1e-5));
  EXPECT_LE(std::sqrt(certified), std::sqrt(by_hand) * more);
}

TEST(NormalField, TheContactTermsAreWhatTheyAreByHand)
{
  for (const int p : {1, 2, 3})
    for (const auto& [name, surface] : obstacles(2))
      for (const problem::ContactLaw& law : laws())
      {
        const DiscreteProblem<2> c(arched_block<2>(4), pressed_on<2>(contact_with(surface, law, 2)),
                                   {.degree = p});
        SCOPED_TRACE(fmt::format("{}, p = {}, {}", name, p, problem::name(law)));
        expect_terms(c, c.solve().u, 1.05, 400);
      }
}

/// A direction that turns aside between the points of the rule, by so little of the facet that no point sees
/// it.
TEST(NormalField, WhatHappensBetweenThePointsIsSeen)
{
  const std::string angle = "(0.4*exp(-((x-0.1234)/0.0004)^2))";
  problem::Contact contact(Coulomb(0.3), 0.0);
  contact.normal = problem::NormalField({formula("sin" + angle), formula("-cos" + angle)});
  const DiscreteProblem<2> c(arched_block<2>(4), pressed_on<2>(contact), {.degree = 2});
  for (const contact::ContactPoint<2>& point : c.form.contact_points())
    ASSERT_LE(std::abs(point.normal[0]), 1e-6);
  std::vector<double> u(c.space.n_dofs(), 0.0);
  for (std::size_t i = 1; i < u.size(); i += 2) u[i] = -0.01;
  expect_terms(c, u, 1.2, 4000);
}

/// The certificate must take N where the form took it: half a facet aside is seen by hand. (Where the contact
/// sticks, T hardly depends on N.)
TEST(NormalField, ADirectionAtAnotherPointIsSeen)
{
  const auto [name, surface] = obstacles(2)[1];
  const problem::Contact right = contact_with(surface, Frictionless(), 2);
  const DiscreteProblem<2> c(arched_block<2>(4), pressed_on<2>(right), {.degree = 2});
  problem::Contact wrong = right;
  wrong.normal = contact_with(problem::moved(surface, point({0.125, 0}, 2), {}), Frictionless(), 2).normal;
  const DiscreteProblem<2> aside(arched_block<2>(4), pressed_on<2>(wrong), {.degree = 2});
  const std::vector<double> u = c.solve().u;
  const std::vector<Point<2>> traction = c.form.traction(u);
  const certify::Stress<2>::Tractions t{
      traction, std::vector<Point<2>>(traction.size(), Point<2>::Zero()), {}};
  double mutated = 0;
  double by_hand = 0;
  for (std::size_t k = 0; k < c.form.segments().size(); ++k)
  {
    const certify::ContactSquares squares =
        certify::ContactTerms<2>(aside.form, certify::ContactRule::resolved)(static_cast<int>(k), u, t);
    mutated += squares.cnt + squares.frc;
    by_hand += squares_by_hand<2>(c, k, u, traction, 400);
  }
  EXPECT_GT(std::abs(std::sqrt(mutated) - std::sqrt(by_hand)), 0.2 * std::sqrt(by_hand));
}

/// The largest pressure on the arc against the floor.
double largest_pressure(const problem::Contact& contact, const mesh::Mesh<2>& mesh)
{
  ProblemData<2> data = pressed_on<2>(contact);
  data.boundaries[0] = fixed<2>("top", 0.0, -0.02);
  const problem::Problem<2> problem = data.on(mesh);
  const fem::LagrangeSpace<2> space(mesh, 2);
  const adapt::Method method{.degree = 2};
  const contact::NitscheForm<2> form(problem, space, method.gamma_0());
  const solve::NewtonResult<2> newton = solve::solve<2>(form, {}, method.newton, method.solver);
  double largest = 0;
  const std::vector<Point<2>> traction = form.traction(newton.u);
  for (std::size_t i = 0; i < traction.size(); ++i)
    largest = std::max(largest, -traction[i].dot(form.contact_points()[i].normal));
  return largest;
}

/// The same, the twelve facets of the arc refined uniformly.
double largest_pressure(const problem::Contact& contact, int refinements)
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

/// Peaks of the polygon grow with refinement; with the obstacle's direction and the gap of the true shape
/// there are none, and the pressure is that of the flat side with the curvature in the gap.
TEST(NormalField, ThePressureHasNoPeaksOfThePolygon)
{
  const problem::Contact polygon(Frictionless(), formula("y"));
  const problem::Contact shape = contact_with(obstacles(2)[0].second, Frictionless(), 2);
  std::vector<double> of_polygon;
  std::vector<double> of_shape;
  for (int level = 0; level <= 3; ++level)
  {
    of_polygon.push_back(largest_pressure(polygon, level));
    of_shape.push_back(largest_pressure(shape, level));
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
