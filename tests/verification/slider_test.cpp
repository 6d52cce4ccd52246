/// @file slider_test.cpp
/// Sliders: exact for affine displacements at any inclination, the numbers of an independent program, bounds
/// above the distance from much richer solutions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "support/discrete_problem.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "support/two_blocks.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/mesh/refine.h"
#include "verification/energy_effectivity.h"
#include "verification/loads_reference.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

using problem::Slider;

/// The block turned: its sides are inclined, and carry no tangential traction.
template <int dim>
void expect_exact(int p)
{
  const Tensor<dim> turn = rotation<dim>();
  Point<dim> principal;
  for (int a = 0; a < dim; ++a) principal[a] = 0.1 - 0.15 * a;  // tension along the first axis
  const problem::Material material = lame(1, 0.3);
  const Tensor<dim> stress = turn * principal.asDiagonal() * turn.transpose();
  const Tensor<dim> strain = (stress - material.lambda / (dim * material.lambda + 2 * material.mu) *
                                           stress.trace() * Tensor<dim>::Identity()) /
                             (2 * material.mu);
  const auto along = [&](const Point<dim>& n)  // u . n
  {
    const Point<dim> g = strain * n;
    return formula(fmt::format("{:.17g}*x + {:.17g}*y + {:.17g}{}", g[0], g[1], dim == 3 ? g[dim - 1] : 0.0,
                               dim == 3 ? "*z" : ""));
  };
  const auto traction = [&](const std::string& name, const Point<dim>& n)
  {
    const Point<dim> t = stress * n;
    return loaded<dim>(name, t[0], t[1], t[dim - 1]);
  };
  const Point<dim> x = turn.col(0);
  const Point<dim> y = turn.col(1);
  const Point<dim> z = turn.col(dim - 1);
  ProblemData<dim> data{
      .boundaries = {obstacle<dim>("left", Slider(), along(-x)), obstacle<dim>("bottom", Slider(), along(-y)),
                     traction("right", x), traction("top", y)},
      .material = material};
  if (dim == 3)
  {
    data.boundaries.push_back(obstacle<dim>("back", Slider(), along(-z)));
    data.boundaries.push_back(traction("front", z));
  }
  const DiscreteProblem<dim> c(
      renumbered(mapped<dim>(block<dim>({3, 2}, {2, 1, 1}),
                             [&](const Point<dim>& at) -> Point<dim> { return turn * at; }),
                 3),
      data, {.degree = p, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> found = c.solve();
  EXPECT_EQ(found.steps.size(), 1U);
  const std::vector<Point<dim>> nodes = c.space.node_points();
  for (Index i = 0; i < c.space.n_nodes(); ++i)
    for (int a = 0; a < dim; ++a) EXPECT_NEAR(found.u[dim * i + a], (strain * nodes[i])[a], 1e-12);
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, found.u);
  EXPECT_EQ(bound.reason, "");
  EXPECT_LE(bound.bound, 1e-7);
}

TEST(Slider, HoldsInclinedSidesExactly)
{
  for (int p = 1; p <= 4; ++p)
  {
    SCOPED_TRACE(p);
    expect_exact<2>(p);
    expect_exact<3>(p);
  }
}

TEST(Slider, AgreesWithThePrototype)
{
  expect_reference("slider", {.boundaries = {clamped<2>("left"), loaded<2>("right", 0.04, 0.2),
                                             loaded<2>("top", 0.0, 0.05),
                                             obstacle<2>("bottom", Slider(), formula("0.02*x*(2 - x)"))}});
}

/// A block that a slider holds below, in tension and pressure, with a motion that need not be polynomial; it
/// is 0 on the left, where the block may be clamped.
template <int dim>
void expect_bounds(unsigned seed, int p)
{
  RandomCase<dim> block_of{std::mt19937(seed)};
  ProblemData<dim> data = block_of.data();
  if (!block_of.is_held_above) data.boundaries[0] = clamped<dim>("left");
  const bool is_smooth = seed % 2 == 0;
  for (problem::BoundaryCondition<dim>& boundary : data.boundaries)
    if (boundary.contact)
      boundary = obstacle<dim>(boundary.name, Slider(), formula(is_smooth ? "0.02*x" : "0.01*sin(2*x)"));
  const DiscreteProblem<dim> c(block_of.mesh(), data, {.degree = p, .newton = {.tolerance = 1e-12}});
  const std::vector<double> u = c.solve().u;
  const Asked<dim> asked(block_of.is_held_above);
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u, asked.quantities);
  const certify::RicherSpace richer{.refinements = dim == 2 ? 2 : 1, .degree = std::min(p + 2, 4)};
  const double found = effectivity<dim>(RicherReference<dim>(c, richer), u, bound);
  fmt::print("{}D, seed {}, p = {}: {:.3f}\n", dim, seed, p, found);
  EXPECT_GE(found, 1) << seed;
  EXPECT_LE(found, 8) << seed;  // nu = 0.49 with p = 1
  if (!is_smooth) return;       // the reference has another interpolant of the motion
  const DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, richer.refinements).mesh), data,
                                  {.degree = richer.degree, .newton = {.tolerance = 1e-11}});
  const std::vector<double> truth = rich.solve().u;
  for (std::size_t i = 0; i < asked.values.size(); ++i)
    expect_contains(bound.quantities[i], asked.values[i](rich, truth), fmt::format(", seed {}", seed));
}

TEST(Slider, NoBoundOrIntervalFails)
{
  for (unsigned seed = 0; seed < n_cases(16); ++seed) expect_bounds<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(3); ++seed) expect_bounds<3>(seed, 1 + static_cast<int>(seed % 2));
}

/// The upper block is lifted, and slides along the lower one.
template <int dim>
ProblemData<dim> lifted()
{
  return {.boundaries = {fixed<dim>("left", 0.0, free, free), clamped<dim>("bottom_below"),
                         loaded<dim>("top", formula("0.02*x"), 0.05), loaded<dim>("right", 0.03, 0.0)},
          .pairs = {pair<dim>("bottom", "top_below", Slider())}};
}

TEST(Slider, JoinsBodies)
{
  for (const int p : {1, 2, 3})
    EXPECT_EQ((expect_effectivity<2>("joined", lifted<2>(), matching_blocks<2>(), p,
                                     {.refinements = 3, .degree = p + 1}, 1.8)
                   .target),
              certify::EnergyTarget::solution);
  ProblemData<3> data = lifted<3>();
  data.boundaries.push_back(fixed<3>("back", free, free, 0.0));
  expect_effectivity<3>("joined", data, matching_blocks<3>(), 1, {.refinements = 2, .degree = 2}, 3);
  const DiscreteProblem<3> torn(two_blocks<3>(), data, {.degree = 1});
  EXPECT_EQ(adapt::energy_bound<3>(torn.form, torn.method, torn.solve().u).reason,
            "meshes of bodies joined by a slider do not match");
}

/// A ring pressed into another one; `n` facets along the arc. Returns the mean pressure between them.
double pressure_in_sector(int n)
{
  const auto ring = [n](double inner, double outer)
  {
    return mapped<3>(box<3>({inner, 0, 0}, {outer, std::numbers::pi / 6, 0.5}, {n, n, 1}),
                     [](const Point<3>& at) -> Point<3> {
                       return {at[0] * std::cos(at[1]), at[0] * std::sin(at[1]), at[2]};
                     });
  };
  mesh::MeshData<3> mesh = side_by_side(ring(1, 2), ring(2, 3), "_outer");
  mesh.interfaces = {{{{{"right"}, {"left_outer"}}}}};
  ProblemData<3> data{.material = lame(1, 0.3), .pairs = {pair<3>("right", "left_outer")}};
  data.pairs[0].contact.gap = -0.01;
  for (const std::string body : {"", "_outer"})
  {
    data.boundaries.push_back(fixed<3>("bottom" + body, free, 0.0, free));
    data.boundaries.push_back(obstacle<3>("top" + body, Slider()));
    for (const std::string end : {"back", "front"})
      data.boundaries.push_back(fixed<3>(end + body, free, free, 0.0));
  }
  const DiscreteProblem<3> c(std::move(mesh), data, {.degree = 2, .newton = {.tolerance = 1e-10}});
  const solve::NewtonResult<3> found = c.solve();
  double area = 0;
  for (std::size_t i = 0; i < c.form.n_contact_points(); ++i)
    if (c.form.segments()[i / c.form.n_segment_points()].master) area += c.form.contact_points()[i].weight;
  const int tag = problem::group_number("right", c.mesh.boundary_names(), {}, "boundary");
  return -contact::contact_resultants<3>(c.form, found.traction, tag).normal / area;
}

/// 30 degrees between an inclined slider and an axis, against Lame's pressure in plane strain: p = delta E /
/// (1
/// - nu^2) / b / ((c^2 + b^2) / (c^2 - b^2) + (b^2 + a^2) / (b^2 - a^2)), a = 1, b = 2, c = 3. Facets in
/// place of arcs leave an error of second order.
TEST(Slider, CutsASectorOutOfAPressFit)
{
  const double exact = 0.01 / (1 - 0.3 * 0.3) / 2 / (13.0 / 5 + 5.0 / 3);
  const double coarse = pressure_in_sector(2) / exact - 1;
  const double fine = pressure_in_sector(4) / exact - 1;
  EXPECT_LE(std::abs(fine), 0.005);
  EXPECT_NEAR(coarse / fine, 4, 0.5);
}

TEST(Slider, RefusesDirectionsAlongFacets)
{
  ProblemData<2> data{.boundaries = {clamped<2>("left"), obstacle<2>("bottom", Slider())}};
  data.boundaries.back().contact->normal =
      problem::NormalField({problem::Field(0.96), problem::Field(-0.28)});
  const std::string message = message_of(
      [&] {
        return DiscreteProblem<2>(block<2>({2, 2}), data).form.n_contact_points();
      });
  EXPECT_NE(message.find("acts at 74 degrees from the normal"), std::string::npos) << message;
}

}  // namespace

}  // namespace tribound::test
