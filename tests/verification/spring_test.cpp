/// @file spring_test.cpp
/// Elastic supports: exact where the solution is affine, the numbers of an independent program, forces in
/// balance, bounds above the distance from much richer solutions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/energy/free_motions.h"
#include "tribound/mesh/refine.h"
#include "verification/effectivity.h"
#include "verification/energy_effectivity.h"
#include "verification/loads_reference.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

template <int dim>
problem::BoundaryCondition<dim> spring(const std::string& name, problem::Field normal,
                                       problem::Field tangential, std::array<problem::Field, dim> rest = {})
{
  problem::BoundaryCondition<dim> condition;
  condition.name = name;
  condition.spring = problem::Spring<dim>{std::move(normal), std::move(tangential), std::move(rest)};
  return condition;
}

TEST(Spring, AgreesWithThePrototype)
{
  expect_reference("spring_left", {.boundaries = {spring<2>("left", 2.0, 1.0), loaded<2>("right", 0.04, 0.06),
                                                  loaded<2>("top", 0.0, -0.1),
                                                  obstacle<2>("bottom", problem::Coulomb(0.5))}});
}

/// Pulled along x, as long as springs let it: u_x = x s / E' + s / k, also from another place of rest.
template <int dim>
void expect_exact(int p)
{
  const double pull = 0.1;
  std::array<problem::Field, dim> rest;
  rest[0] = 0.3;
  ProblemData<dim> data{.boundaries = {spring<dim>("left", 2.0, 1.0, rest), loaded<dim>("right", pull, 0.0)},
                        .material = lame(1, 0)};
  for (const char* side : {"bottom", "back"})
    if (dim == 3 || std::string(side) == "bottom")
      data.boundaries.push_back(std::string(side) == "bottom" ? fixed<dim>(side, free, 0.0, free)
                                                              : fixed<dim>(side, free, free, 0.0));
  const DiscreteProblem<dim> c(renumbered(block<dim>({3, 2}, {2, 1, 1}), 3), data,
                               {.degree = p, .newton = {.tolerance = 1e-13}});
  const std::vector<double> u = c.solve().u;
  const std::vector<Point<dim>> nodes = c.space.node_points();
  for (Index i = 0; i < c.space.n_nodes(); ++i)
    EXPECT_NEAR(u[dim * i], 0.3 + pull * nodes[i][0] + pull / 2, 1e-12);
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u);
  EXPECT_EQ(bound.reason, "");
  EXPECT_LE(bound.bound, 1e-9);
  const certify::Balance balance = certify::balance<dim>(
      c.form, u, std::vector<Point<dim>>(c.form.n_contact_points()), Point<dim>::Zero());
  for (const certify::BalanceRow& row : balance.rows)
  {
    if (row.kind == certify::BalanceKind::spring)
    {
      EXPECT_NEAR(row.force[0], -pull, 1e-12);
    }
    if (row.kind == certify::BalanceKind::sum)
    {
      EXPECT_NEAR(row.force[0], 0, 1e-12);
    }
  }
}

TEST(Spring, IsExactForAffineDisplacements)
{
  for (int p = 1; p <= 4; ++p)
  {
    SCOPED_TRACE(p);
    expect_exact<2>(p);
    expect_exact<3>(p);
  }
}

/// The integral of K (u - rest) . f(u) over the right side, K = k_n n n^T + k_t (I - n n^T); or without rest.
template <int dim, class F>
double spring_product(const DiscreteProblem<dim>& c, std::span<const double> u, const F& f,
                      bool has_rest = true)
{
  double sum = 0;
  for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = c.problem.boundary(facet.tag);
    if (boundary.name != "right") continue;
    const problem::Spring<dim>& spring = *boundary.spring;
    const Point<dim> n = mesh::facet_geometry(c.mesh, facet.cell, facet.local).normal;
    const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * c.space.degree() + 2);
    const auto table = c.space.basis().tabulate(fem::points_on_facet<dim>(facet.local, rule.points));
    for (const auto& [q, x, dx] : fem::facet_points(c.mesh, facet.cell, facet.local, rule))
    {
      const Point<dim> at = fem::value_at<dim>(c.space.cell_nodes(facet.cell), u, table.values_at(q));
      Point<dim> moved = at;
      for (int a = 0; a < dim && has_rest; ++a) moved[a] -= spring.rest[a](x);
      const Point<dim> along = n.dot(moved) * n;
      sum += dx * (spring.normal(x) * along + spring.tangential(x) * (moved - along)).dot(f(at));
    }
  }
  return sum;
}

/// A block on springs at its right side, soft to stiff, that nothing else may hold.
template <int dim>
void expect_bounds(unsigned seed, int p)
{
  RandomCase<dim> block_of{std::mt19937(seed)};
  ProblemData<dim> data = block_of.data();
  const double stiffness = std::pow(10, block_of.between(-2, 2));
  std::array<problem::Field, dim> rest;
  rest[0] = block_of.between(-0.02, 0.02);
  const auto right = std::ranges::find(data.boundaries, "right", &problem::BoundaryCondition<dim>::name);
  const bool varies = block_of.happens(3);
  right->spring = problem::Spring<dim>{varies ? formula(fmt::format("{}*(y - 0.5)^2", stiffness)) : stiffness,
                                       block_of.happens(2) ? 0.0 : stiffness / 3, rest};
  const bool is_on_springs = block_of.happens(2);
  if (is_on_springs) data.boundaries[0] = spring<dim>(data.boundaries[0].name, 0.5, 0.2);
  const DiscreteProblem<dim> c(block_of.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-12}});
  const std::vector<double> u = c.solve().u;
  Asked<dim> asked(block_of.is_held_above || is_on_springs);
  asked.values[1] = [](const auto& c, auto u)  // the load has (K rest, u)
  {
    const auto itself = [](const Point<dim>& at) { return at; };
    const double with_rest = spring_product<dim>(c, u, itself);
    return c.space.dot(c.form.load(), u) + with_rest - spring_product<dim>(c, u, itself, false);
  };
  const Point<dim> e = Point<dim>::Ones().normalized();
  asked.quantities.push_back(
      {.name = "spring", .kind = problem::QuantityKind::spring_force, .boundary = "right", .direction = e});
  asked.values.push_back([e](const auto& c, auto u)
                         { return -spring_product<dim>(c, u, [&](const Point<dim>&) { return e; }); });
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u, asked.quantities);
  const certify::RicherSpace richer{.refinements = dim == 2 ? 2 : 1, .degree = std::min(p + 2, 4)};
  const double found = effectivity<dim>(RicherReference<dim>(c, richer), u, bound);
  fmt::print("{}D, seed {}, p = {}: {:.3f}\n", dim, seed, p, found);
  EXPECT_GE(found, 1) << seed;
  EXPECT_LE(found, 8) << seed;
  const DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, richer.refinements).mesh), data,
                                  {.degree = richer.degree, .newton = {.tolerance = 1e-11}});
  const std::vector<double> truth = rich.solve().u;
  const double left = 1e-10;  // by Newton's method; with nu = 0 the force of a spring is known to rounding
  for (std::size_t i = 0; i < asked.values.size(); ++i)
    expect_contains(bound.quantities[i], asked.values[i](rich, truth), fmt::format(", seed {}", seed), left);
}

TEST(Spring, NoBoundOrIntervalFails)
{
  for (unsigned seed = 0; seed < n_cases(16); ++seed) expect_bounds<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(3); ++seed) expect_bounds<3>(seed, 1 + static_cast<int>(seed % 2));
}

/// Springs with constant, linear and quadratic stiffness, one that jumps between facets, one that is no
/// polynomial, one that jumps inside a facet, and one whose denominator vanishes for all that a single
/// enclosure on a facet knows.
ProblemData<2> on_varying_springs(int which)
{
  const std::array<problem::Field, 7> stiffness = {2.0,
                                                   formula("1 + x"),
                                                   formula("2 - y + 0.3*y^2"),
                                                   formula("x < 1 ? 0.01 : 3"),
                                                   formula("exp(x) + y"),
                                                   formula("x < 0.77 ? 1 : 3"),
                                                   formula("1/(x^2 - 1.9*x + 1)")};
  const std::array<problem::Field, 7> rest = {formula("0.1*y^2 - 0.05*y^3"),
                                              formula("0.1*x"),
                                              formula("0.02*x*y"),
                                              0.1,
                                              formula("0.1*sin(3*x)"),
                                              0.1,
                                              0.1};
  return {.boundaries = {spring<2>("bottom", stiffness[which], 1.0, {0.0, rest[which]}),
                         spring<2>("left", 0.7, stiffness[which], {rest[which], 0.0}),
                         loaded<2>("right", 0.05, 0.1), loaded<2>("top", 0.02, -0.1)}};
}

TEST(Spring, VaryingStiffnessAndRestAreBounded)
{
  for (int which = 0; which < 7; ++which)
    for (const int p : {1, 2, 3})
    {
      SCOPED_TRACE(fmt::format("{}, p = {}", which, p));
      const bool is_polynomial = which < 4;
      const int n = which == 4 ? 4 : 1;
      const mesh::MeshData<2> mesh = renumbered(block<2>({4 * n, 3 * n}), 5);
      const Effectivities found = effectivities<2>(
          {p, {fmt::format("springs {}", which), on_varying_springs(which)}, {"block", mesh}});
      for (const double effectivity : found.of_iterates) EXPECT_GE(effectivity, 1);
      EXPECT_LE(found.last(), which < 5 ? 2 : HUGE_VAL);
      const DiscreteProblem<2> c(mesh, on_varying_springs(which), {.degree = p});
      const std::vector<double> u = c.solve().u;
      const certify::EnergyBound bound = adapt::energy_bound<2>(c.form, c.method, u);
      EXPECT_EQ(bound.reason, is_polynomial ? "" : "the stiffness of a spring is no polynomial of degree 2");
      if (!is_polynomial) continue;
      const RicherReference<2> reference(c, {.refinements = 2, .degree = std::min(p + 2, 4)});
      const double of_energy = effectivity<2>(reference, u, bound);
      EXPECT_GE(of_energy, 1);
      EXPECT_LE(of_energy, 2);
    }
}

/// K (u_h) is of degree 3 on the only facet with a spring, and u_h and the loads are affine: with P_3 of
/// Legendre in s = 2 x - 1 and a zero s_0 of c + P_3, u_y = a (s - s_0) + k a c y and K = k (c + P_3)/(s -
/// s_0), which is quadratic and positive. All of the error comes from the part k a P_3 of the spring's force,
/// and so does all of the width of intervals.
TEST(Spring, OscillationOfItsForceIsInIntervals)
{
  const double s_0 = -1.05;
  const double c = 1.3190625;
  const double a = 0.1;
  const problem::Field k =
      formula(fmt::format("2.5*(2*x - 1)^2 + {0}*(2*x - 1) - 1.5 + {0}*{1}", 2.5 * s_0, s_0));
  ProblemData<2> data{.boundaries = {spring<2>("bottom", k, 0.0), loaded<2>("top", a, a * c),
                                     loaded<2>("left", 0.0, -a), loaded<2>("right", 0.0, a)},
                      .material = lame(1, 0)};
  data.boundaries[0].displacement[0] = 0.0;
  mesh::MeshData<2> square = block<2>({1, 1});
  for (Point<2>& x : square.vertices) x[0] /= 2;
  const DiscreteProblem<2> problem(square, data, {.degree = 2, .newton = {.tolerance = 1e-13}});
  const std::vector<double> u = problem.solve().u;
  const std::vector<Point<2>> nodes = problem.space.node_points();
  for (Index i = 0; i < problem.space.n_nodes(); ++i)
    EXPECT_NEAR(u[2 * i + 1], a * (2 * nodes[i][0] - 1 - s_0) + a * c * nodes[i][1], 1e-12);
  const std::vector<problem::Quantity<2>> asked = {
      {.name = "work", .kind = problem::QuantityKind::load_work}};
  const certify::EnergyBound bound = adapt::energy_bound<2>(problem.form, problem.method, u, asked);
  ASSERT_EQ(bound.reason, "");
  const DiscreteProblem<2> rich(std::move(mesh::refine_uniformly(problem.mesh, 3).mesh), data,
                                {.degree = 4, .newton = {.tolerance = 1e-12}});
  const std::vector<double> truth = rich.solve().u;
  const double work = rich.space.dot(rich.form.load(), truth);
  EXPECT_GT(std::abs(work - problem.space.dot(problem.form.load(), u)), 1e-6 * work);
  expect_contains(bound.quantities[0], work, "", 1e-12);
  // The dual problem is the problem itself. What its stress lacks counts with B_v; the true error, which is
  // less than constants allow, would not tell if that were left out.
  EXPECT_GE(bound.quantities[0].upper - bound.quantities[0].lower, 2 * bound.oscillation * bound.b_v);
}

/// Facets on springs that are inclined to a component that is fixed: K acts on the other, from where it is.
TEST(Spring, ActsBesideAFixedComponentOnAnInclinedFacet)
{
  mesh::MeshData<2> mesh = renumbered(block<2>({4, 3}), 2);
  for (Point<2>& x : mesh.vertices) x[1] += 0.25 * x[0] * (1 - x[1]);  // the bottom rises along x
  ProblemData<2> data{.boundaries = {spring<2>("bottom", 2.0, 0.5), loaded<2>("top", 0.02, -0.1),
                                     loaded<2>("right", 0.0, 0.05)}};
  data.boundaries[0].displacement[0] = 0.01;
  for (int p = 1; p <= 3; ++p)
  {
    const DiscreteProblem<2> c(mesh, data, {.degree = p, .newton = {.tolerance = 1e-12}});
    const std::vector<double> u = c.solve().u;
    const std::vector<problem::Quantity<2>> asked = {{.name = "force",
                                                      .kind = problem::QuantityKind::spring_force,
                                                      .boundary = "bottom",
                                                      .direction = Point<2>::UnitY()}};
    const certify::EnergyBound bound = adapt::energy_bound<2>(c.form, c.method, u, asked);
    const double found = effectivity<2>(RicherReference<2>(c, {.refinements = 2, .degree = 4}), u, bound);
    EXPECT_GE(found, 1) << p;
    EXPECT_LE(found, 3) << p;
    double down = 0;  // of the loads
    for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
    {
      const double measure = mesh::facet_geometry(c.mesh, facet.cell, facet.local).measure;
      const std::string& name = c.mesh.boundary_names()[facet.tag];
      down += name == "top" ? 0.1 * measure : name == "right" ? -0.05 * measure : 0;
    }
    EXPECT_TRUE(bound.quantities[0].exact);  // nothing else acts along y
    EXPECT_NEAR(bound.quantities[0].lower, down, 1e-12);
    EXPECT_NEAR(bound.quantities[0].value, down, 1e-10);
  }
}

/// A spring across the motion does not share the load of an obstacle; one along it does, however soft.
TEST(Spring, AcrossAMotionLeavesStaticsAlone)
{
  for (const double tangential : {0.0, 1e-6})
  {
    const DiscreteProblem<2> c(block<2>({4, 2}),
                               {.boundaries = {spring<2>("left", 2.0, tangential), obstacle<2>("bottom", {}),
                                               loaded<2>("top", 0.02, -0.1)}},
                               {.degree = 2, .newton = {.tolerance = 1e-12}});
    const std::vector<problem::Quantity<2>> asked = {{.name = "force",
                                                      .kind = problem::QuantityKind::contact_force,
                                                      .boundary = "bottom",
                                                      .direction = Point<2>::UnitY()}};
    const certify::EnergyBound bound = adapt::energy_bound<2>(c.form, c.method, c.solve().u, asked);
    EXPECT_EQ(bound.quantities[0].exact, tangential == 0);
    if (tangential > 0) continue;
    EXPECT_NEAR(bound.quantities[0].lower, 0.2, 1e-12);
  }
}

/// One that is 0 at all vertices holds a body; one that is negative between the points of the rule has no
/// energy; and load steps share one matrix, so that none may name t.
TEST(Spring, IsLookedAtBetweenVerticesAndPoints)
{
  const auto on = [](const char* stiffness)
  {
    return ProblemData<2>{
        .boundaries = {spring<2>("bottom", formula(stiffness), 0.1), loaded<2>("top", 0.02, -0.1)}};
  };
  const DiscreteProblem<2> held(block<2>({2, 1}), on("sin(pi*x)^2"), {.degree = 2});
  EXPECT_EQ(held.solve().status, solve::NewtonStatus::converged);
  EXPECT_EQ(certify::FreeMotions<2>(held.problem, held.mesh).size(), 0);

  const DiscreteProblem<2> negative(block<2>({1, 1}), on("(x - 0.365)^2 - 0.005"), {.degree = 2});
  EXPECT_EQ(adapt::energy_bound<2>(negative.form, negative.method, negative.solve().u).reason,
            "the stiffness of a spring is negative somewhere");
  const DiscreteProblem<2> between(block<2>({2, 1}), on("x < 1 ? (x - 0.86)^2 - 0.001 : 1"), {.degree = 2});
  EXPECT_EQ(between.form.springs().why_unclear(), "the stiffness of a spring is negative somewhere");
  EXPECT_THROW(DiscreteProblem<2>(block<2>({2, 1}), on("2 - t"), {.degree = 2}), InputError);
  mesh::MeshData<2> rounded = block<2>({2, 1});
  for (Point<2>& x : rounded.vertices) x[1] -= 1e-17;
  EXPECT_NO_THROW(DiscreteProblem<2>(rounded, on("1e7*y"), {.degree = 2}));
}

/// C_F of a body that only springs hold: no function may beat it.
template <int dim>
void expect_friedrichs(Index most_factorised)
{
  const DiscreteProblem<dim> c(block<dim>({3, 2}, {2, 1, 1}),
                               {.boundaries = {spring<dim>("left", 1e-3, 0.0)}}, {.degree = 2});
  const certify::FriedrichsConstant constant =
      certify::friedrichs_constant<dim>(c.problem, c.mesh, most_factorised);
  ASSERT_TRUE(std::isfinite(constant.value));
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(6);
  const fem::Quadrature<dim - 1> facet_rule = fem::quadrature<dim - 1>(6);
  for (const double x0 : {0.0, -0.3, -1.0, 5.0})  // v = (x - x0)^k
    for (const int k : {0, 1, 2})
    {
      double squares = 0;
      double norm = 0;
      const auto v = [&](const Point<dim>& x) { return std::pow(x[0] - x0, k); };
      for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
        for (const auto& [q, x, dx] : fem::cell_points<dim>(mesh::cell_map(c.mesh, cell), rule))
        {
          squares += dx * v(x) * v(x);
          norm += k == 0 ? 0 : dx * std::pow(k * std::pow(x[0] - x0, k - 1), 2);
        }
      for (const mesh::BoundaryFacet& facet : c.mesh.boundary())
        if (c.problem.boundary(facet.tag).spring)
          for (const auto& [q, x, dx] : fem::facet_points(c.mesh, facet.cell, facet.local, facet_rule))
            norm += dx * v(x) * v(x) / mesh::facet_geometry(c.mesh, facet.cell, facet.local).diameter;
      EXPECT_LE(std::sqrt(squares), constant.value * std::sqrt(norm)) << x0 << ", " << k;
    }
}

TEST(Spring, HoldsABodyAlone)
{
  for (const Index most : {certify::most_cells_factorised, Index{0}})
  {
    expect_friedrichs<2>(most);
    expect_friedrichs<3>(most);
  }
}

}  // namespace

}  // namespace tribound::test
