/// @file rigid_part_test.cpp
/// Parts of the boundary that move as rigid bodies: exact where the solution is a polynomial, the reactions
/// of the same motion prescribed, bounds above dual norms and distances from much richer solutions.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/friedrichs.h"
#include "tribound/certify/bound/rigid_remainder.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/refine.h"
#include "verification/effectivity.h"
#include "verification/energy_effectivity.h"
#include "verification/random_quantities.h"

namespace tribound::test
{

namespace
{

template <int dim>
problem::BoundaryCondition<dim> rigid(const std::string& name, const problem::RigidPart<dim>& part)
{
  problem::BoundaryCondition<dim> condition;
  condition.name = name;
  condition.rigid = part;
  return condition;
}

/// On the right side of a block of length 2 and height 1.
template <int dim>
problem::RigidPart<dim> pulled_and_bent(double force, double moment)
{
  problem::RigidPart<dim> part;
  part.point = Point<dim>::Constant(0.5);
  part.point[0] = 2;
  part.force[0] = force;
  part.moment.back() = moment;
  return part;
}

/// With nu = 0 a cantilever under a force along it and a moment has u_x = F x - theta x (y - 1/2) / 2 and u_y
/// = theta x^2 / 4, theta = 24 M.
template <int dim>
void expect_exact(int p)
{
  const double force = 0.1;
  const double moment = p > 1 ? 0.01 : 0;
  const double theta = 24 * moment;
  const ProblemData<dim> data{
      .boundaries = {clamped<dim>("left"), rigid<dim>("right", pulled_and_bent<dim>(force, moment))},
      .material = lame(1, 0)};
  const DiscreteProblem<dim> c(renumbered(block<dim>({3, 2}, {2, 1, 1}), 3), data,
                               {.degree = p, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> newton = c.solve();
  const std::vector<double>& u = newton.u;
  const std::vector<Point<dim>> nodes = c.space.node_points();
  for (Index i = 0; i < c.space.n_nodes(); ++i)
  {
    const Point<dim>& x = nodes[i];
    EXPECT_NEAR(u[dim * i], force * x[0] - theta * x[0] * (x[1] - 0.5) / 2, 1e-12);
    EXPECT_NEAR(u[dim * i + 1], theta * x[0] * x[0] / 4, 1e-12);
  }
  const std::vector<contact::PartMotion<dim>> motions = c.form.rigid_parts().motions(c.problem, u);
  ASSERT_EQ(motions.size(), 1U);
  EXPECT_NEAR(motions[0].translation[0], 2 * force, 1e-12);
  EXPECT_NEAR(motions[0].translation[1], theta, 1e-12);
  EXPECT_NEAR(motions[0].rotation[motions[0].rotation.size() - 1], theta, 1e-12);
  for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
    EXPECT_LE(
        certify::estimate<dim>(c.form, u, certify::equilibrate<dim>(c.form, u, newton.traction, 0, 0, kind))
            .total_sharp,
        1e-10);
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u);
  EXPECT_EQ(bound.reason, "");
  EXPECT_LE(bound.bound, 1e-9);
}

TEST(RigidPart, IsExactUnderForceAndMoment)
{
  for (int p = 1; p <= 4; ++p)
  {
    SCOPED_TRACE(p);
    expect_exact<2>(p);
    expect_exact<3>(p);
  }
}

/// Half of a block, pressed by a guided platen; the plane of symmetry is x = 0.
TEST(RigidPart, MeetsAPlaneOfSymmetry)
{
  problem::RigidPart<2> platen;
  platen.force[1] = -0.1;
  platen.fixed = {true, false, true};
  const auto data_of = [&](const problem::RigidPart<2>& part)
  {
    return ProblemData<2>{
        .boundaries = {fixed<2>("left", 0.0, free), fixed<2>("bottom", 0.0, 0.0), rigid<2>("top", part)},
        .material = lame(1, 0.3)};
  };
  const mesh::MeshData<2> mesh = block<2>({4, 2}, {2, 1});
  const DiscreteProblem<2> c(mesh, data_of(platen), {.degree = 2});
  const solve::NewtonResult<2> newton = c.solve();
  EXPECT_LT(c.form.rigid_parts().motions(c.problem, newton.u).at(0).translation[1], -0.03);
  for (const certify::BalanceRow& row :
       certify::balance<2>(c.form, newton.u, newton.traction, Point<2>::Zero()).rows)
  {
    const double sum = row.kind == certify::BalanceKind::sum ? 1 : 0;
    EXPECT_NEAR(sum * row.force.at(1), 0, 1e-12);
    EXPECT_NEAR(sum * row.moment.at(0), 0, 1e-12);
  }
  platen.fixed = {};
  EXPECT_THAT(message_of([&] { (void)DiscreteProblem<2>(mesh, data_of(platen), {.degree = 2}); }),
              testing::AllOf(testing::HasSubstr("meets \"left\""), testing::HasSubstr("prescribes x")));
}

/// A slider beside the part holds it at their common corner; a part that is fixed in all motions is clamped.
TEST(RigidPart, MeetsASliderAndIsClampedWhereAllIsFixed)
{
  problem::RigidPart<2> platen;
  platen.force[1] = -0.1;
  const auto data_of = [&](const problem::RigidPart<2>& part)
  {
    return ProblemData<2>{.boundaries = {obstacle<2>("left", problem::Slider()), clamped<2>("bottom"),
                                         loaded<2>("right", 0.1, 0.0), rigid<2>("top", part)},
                          .material = lame(1, 0.3)};
  };
  const mesh::MeshData<2> mesh = block<2>({4, 2}, {2, 1});
  EXPECT_THAT(message_of([&] { (void)DiscreteProblem<2>(mesh, data_of(platen), {.degree = 2}); }),
              testing::HasSubstr("meets \"left\""));
  platen.fixed = {true, true, true};
  const DiscreteProblem<2> guided(mesh, data_of(platen), {.degree = 2, .newton = {.tolerance = 1e-13}});
  ProblemData<2> held = data_of(platen);
  held.boundaries.back() = clamped<2>("top");
  const DiscreteProblem<2> c(mesh, held, {.degree = 2, .newton = {.tolerance = 1e-13}});
  const std::vector<double> expected = c.solve().u;
  const std::vector<double> found = guided.solve().u;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12);
}

TEST(RigidPart, PartsDoNotTouchAndDoNotJoinBodies)
{
  const problem::RigidPart<2> part;
  EXPECT_THAT(message_of(
                  [&]
                  {
                    (void)DiscreteProblem<2>(
                        block<2>({4, 2}, {2, 1}),
                        {.boundaries = {rigid<2>("top", part), rigid<2>("right", part)}});
                  }),
              testing::HasSubstr("meets the rigid part"));
  mesh::MeshData<2> two = matching_blocks<2>();
  for (std::string& name : two.boundary_names)
    if (name == "right_below") name = "shared";
  const auto of_above = std::ranges::find(two.boundary_names, "right") - two.boundary_names.begin();
  const auto of_below = std::ranges::find(two.boundary_names, "shared") - two.boundary_names.begin();
  for (mesh::TaggedFacet<2>& facet : two.facets)
    if (facet.tag == of_above) facet.tag = static_cast<int>(of_below);
  EXPECT_THAT(message_of(
                  [&]
                  {
                    (void)DiscreteProblem<2>(two,
                                             {.boundaries = {rigid<2>("shared", part)},
                                              .pairs = {pair<2>("bottom", "top_below", Frictionless())}});
                  }),
              testing::HasSubstr("is a rigid part on several bodies"));
}

/// A random block with a rigid part: on its right side, held at its left, or above, on springs at its left.
template <int dim>
struct RigidCase
{
  RandomCase<dim> block_of;
  bool is_above;
  problem::RigidPart<dim> part;
  ProblemData<dim> data;

  explicit RigidCase(unsigned seed) : block_of{std::mt19937(seed)}
  {
    while (block_of.is_held_above || data.boundaries.empty()) data = block_of.data();
    is_above = block_of.happens(2);
    for (int a = 0; a < dim; ++a)
    {
      part.force[a] = block_of.between(-0.1, 0.05);
      part.point[a] = block_of.between(0, 1);
    }
    for (problem::Field& moment : part.moment) moment = block_of.between(-0.05, 0.05);
    if (block_of.happens(3)) part.fixed[block_of.random() % part.fixed.size()] = true;
    replace(is_above ? "top" : "right", rigid<dim>(is_above ? "top" : "right", part));
    if (!is_above) return;
    problem::BoundaryCondition<dim> springs;
    springs.name = "left";
    springs.spring = problem::Spring<dim>{0.7, 0.4};
    replace("left", springs);
  }

  void replace(const std::string& name, const problem::BoundaryCondition<dim>& condition)
  {
    std::erase_if(data.boundaries, [&](const auto& boundary) { return boundary.name == name; });
    data.boundaries.push_back(condition);
  }
};

/// The same problem with the motion that was found prescribed has reactions equal to force and moment, but
/// for what guides the part.
template <int dim>
void expect_same_as_prescribed(unsigned seed, int p)
{
  RigidCase<dim> random(seed);
  const mesh::MeshData<dim> mesh = random.block_of.mesh();
  const DiscreteProblem<dim> c(mesh, random.data, {.degree = p, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> newton = c.solve();
  ASSERT_EQ(newton.status, solve::NewtonStatus::converged) << newton.message;
  const contact::PartMotion<dim> motion = c.form.rigid_parts().motions(c.problem, newton.u).at(0);
  std::array<std::optional<problem::Field>, dim> prescribed;
  for (int a = 0; a < dim; ++a)
  {
    Point<dim> slope = Point<dim>::Zero();  // of component a
    if constexpr (dim == 2)
      slope[1 - a] = a == 0 ? -motion.rotation[0] : motion.rotation[0];
    else
    {
      slope[(a + 1) % 3] = -motion.rotation[(a + 2) % 3];
      slope[(a + 2) % 3] = motion.rotation[(a + 1) % 3];
    }
    std::string text = fmt::format("{:.17g}", motion.translation[a]);
    for (int b = 0; b < dim; ++b)
      text += fmt::format(" + {:.17g}*({} - {:.17g})", slope[b], "xyz"[b], random.part.point[b]);
    prescribed[a] = formula(text);
  }
  const std::string name = random.is_above ? "top" : "right";
  random.replace(name, problem::with_displacement<dim>(name, prescribed));
  const DiscreteProblem<dim> held(mesh, random.data, {.degree = p, .newton = {.tolerance = 1e-13}});
  const solve::NewtonResult<dim> same = held.solve();
  const certify::Balance balance = certify::balance<dim>(held.form, same.u, same.traction, random.part.point);
  for (const certify::BalanceRow& row : balance.rows)
  {
    if (row.kind != certify::BalanceKind::reaction || row.name != name) continue;
    for (int a = 0; a < dim; ++a)
    {
      const double guided = random.part.fixed[a] ? row.force[a] : random.part.force[a].constant();
      EXPECT_NEAR(row.force[a], guided, 1e-9) << seed;
    }
    for (std::size_t a = 0; a < row.moment.size(); ++a)
    {
      const double guided = random.part.fixed[dim + a] ? row.moment[a] : random.part.moment[a].constant();
      EXPECT_NEAR(row.moment[a], guided, 1e-9) << seed;
    }
  }
}

TEST(RigidPart, ReactionsOfTheSameMotionAreItsForces)
{
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
    expect_same_as_prescribed<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(4); ++seed)
    expect_same_as_prescribed<3>(seed, 1 + static_cast<int>(seed % 2));
}

template <int dim>
void expect_residual_bound(unsigned seed, int p)
{
  RigidCase<dim> random(seed);
  expect_guaranteed(effectivities<dim>({.degree = p,
                                        .problem = {fmt::format("rigid, seed {}", seed), random.data},
                                        .mesh = {"", random.block_of.mesh()}}),
                    fmt::format("{}D, seed {}", dim, seed));
}

TEST(RigidPart, NoResidualBoundFails)
{
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
    expect_residual_bound<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(2); ++seed) expect_residual_bound<3>(seed, 1);
}

/// The work of a force and a moment that no stress carries, against the norm of what they move.
template <int dim>
void expect_remainder(unsigned seed, int p)
{
  RigidCase<dim> random(seed);
  const DiscreteProblem<dim> c(random.block_of.mesh(), random.data, {.degree = p});
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = 1, .degree = p + 1});
  std::vector<double> load(dual_norm.space().n_dofs(), 0.0);
  contact::RigidParts<dim>(c.problem, dual_norm.space()).add_load(load);
  certify::Stress<dim> none = certify::equilibrate<dim>(c.form, std::vector<double>(c.space.n_dofs(), 0.0),
                                                        std::vector<Point<dim>>(c.form.n_contact_points()), 0,
                                                        0, certify::PatchStress::rows);
  std::ranges::fill(none.dis, 0.0);
  std::ranges::fill(none.lin, 0.0);
  const double bound =
      certify::rigid_remainder<dim>(c.form, none, certify::friedrichs_constant(c.problem, c.mesh).value);
  const double norm = dual_norm.of(load);
  EXPECT_GE(bound, norm) << dim << "D, seed " << seed;
  EXPECT_LE(bound, 100 * norm) << dim << "D, seed " << seed;
}

TEST(RigidPart, WhatTheStressDoesNotCarryIsBounded)
{
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
    expect_remainder<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(3); ++seed) expect_remainder<3>(seed, 1);
}

template <int dim>
void expect_energy_bound(unsigned seed, int p)
{
  RigidCase<dim> random(seed);
  const DiscreteProblem<dim> c(random.block_of.mesh(), random.data,
                               {.degree = p, .newton = {.tolerance = 1e-12}});
  const std::vector<double> u = c.solve().u;
  Asked<dim> asked(random.is_above);
  const std::string name = random.is_above ? "top" : "right";
  const Point<dim> e = Point<dim>::Ones().normalized();
  asked.quantities.push_back(
      {.name = "motion", .kind = problem::QuantityKind::mean_displacement, .boundary = name, .direction = e});
  asked.values.push_back([&](const auto& of, auto displacement)
                         { return mean_over<dim>(of, displacement, name, e); });
  const certify::EnergyBound bound = adapt::energy_bound<dim>(c.form, c.method, u, asked.quantities);
  if (!random.is_above && bound.reason == "a rigid part that touches a contact boundary would have to move")
    return;
  const certify::RicherSpace richer{.refinements = dim == 2 ? 2 : 1, .degree = std::min(p + 2, 4)};
  const double found = effectivity<dim>(RicherReference<dim>(c, richer), u, bound);
  fmt::print("{}D, seed {}, p = {}: {:.3f} {}\n", dim, seed, p, found, bound.quantities.back().reason);
  EXPECT_GE(found, 1) << seed;
  EXPECT_LE(found, 8) << seed;
  const mesh::Refined<dim> refined = mesh::refine_uniformly(c.mesh, richer.refinements);
  const DiscreteProblem<dim> rich(std::move(mesh::refine_uniformly(c.mesh, richer.refinements).mesh),
                                  random.data, {.degree = richer.degree, .newton = {.tolerance = 1e-11}});
  const solve::NewtonResult<dim> of_rich =
      rich.solve_from(fem::nested_interpolant<dim>(c.space, u, refined, rich.space));
  ASSERT_EQ(of_rich.status, solve::NewtonStatus::converged) << seed << of_rich.message;
  const std::vector<double>& truth = of_rich.u;
  for (std::size_t i = 0; i < asked.values.size(); ++i)
    if (bound.quantities[i].reason.empty())
      expect_contains(bound.quantities[i], asked.values[i](rich, truth), fmt::format(", seed {}", seed),
                      1e-10);
}

TEST(RigidPart, NoEnergyBoundOrIntervalFails)
{
  for (unsigned seed = 0; seed < n_cases(12); ++seed)
    expect_energy_bound<2>(seed, 1 + static_cast<int>(seed % 3));
  for (unsigned seed = 0; seed < n_cases(2); ++seed) expect_energy_bound<3>(seed, 1);
}

}  // namespace

}  // namespace tribound::test
