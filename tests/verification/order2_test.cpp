/// @file order2_test.cpp
/// Second-order facets as the shape of a body: comparison with the circle they come from, pressure, bound.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/edge_nodes.h"
#include "tribound/case/quadratic_geometry.h"
#include "tribound/certify/bound/contact_geometry.h"
#include "tribound/mesh/refine.h"
#include "verification/arched_block.h"
#include "verification/sound_effectivity.h"

namespace tribound::test::order2_cases
{

namespace
{

constexpr int bottom = 2;

/// A block on top of the ball of radius 1 that touches y = 0 at the origin. Vertices and edge nodes of its
/// lower side lie on the ball, edge nodes above the midpoints of edges.
template <int dim>
mesh::Mesh<dim> round_block(const std::array<int, dim>& cells)
{
  Point<dim> lower = Point<dim>::Constant(-0.5);
  Point<dim> upper = Point<dim>::Constant(0.5);
  lower[1] = 0;
  upper[1] = 1;
  const Point<dim> centre = Point<dim>::Unit(1);
  mesh::MeshData<dim> data = mapped<dim>(box<dim>(lower, upper, cells),
                                         [](Point<dim> x) -> Point<dim>
                                         {
                                           const double square = x.squaredNorm() - x[1] * x[1];
                                           x[1] += (1 - x[1]) * (1 - std::sqrt(1 - square));
                                           return x;
                                         });
  return mesh::Mesh<dim>(with_edge_nodes<dim>(std::move(data), bottom,
                                              [&](const Point<dim>& x) -> Point<dim>
                                              { return centre + (x - centre).normalized(); }));
}

/// Contact of the lower side with the obstacle, on the surface given by the mesh.
template <int dim>
problem::Contact contact_on(const mesh::Mesh<dim>& mesh, const problem::Surface& obstacle,
                            const problem::ContactLaw& law)
{
  const case_file::QuadraticGeometry<dim> geometry{
      .obstacle = obstacle,
      .shape = std::make_shared<const mesh::QuadraticSurface<dim>>(*mesh.labels().quadratic_facets,
                                                                   std::array{bottom}, Where{}),
      .where = {.file = {}, .key = "contact"}};
  problem::Contact contact(law, case_file::gap_of(geometry));
  contact.normal = case_file::direction_of_obstacle(geometry);
  contact.true_surface = case_file::distance_of_shape(geometry);
  return contact;
}

/// Gap and direction against the circle's, at points of the facets.
TEST(Order2, ConvergesToTheCircle)
{
  for (const auto& [name, obstacle] : obstacles(2))
  {
    std::vector<double> gaps;
    std::vector<double> turns;
    for (const int n : {4, 8, 16, 32})
    {
      const mesh::Mesh<2> mesh = round_block<2>({n, n});
      const problem::Contact quadratic = contact_on<2>(mesh, obstacle, Frictionless());
      const problem::Contact circle = contact_with(obstacle, Frictionless(), 2);
      gaps.push_back(0);
      turns.push_back(0);
      for (const mesh::BoundaryFacet& facet : mesh.boundary())
        for (int i = 0; facet.tag == bottom && i <= 10; ++i)
        {
          const Point<2> x = mesh::facet_map(mesh, facet.cell, facet.local)(Point<1>(i / 10.0));
          gaps.back() = std::max(gaps.back(), std::abs((*quadratic.gap)(x) - (*circle.gap)(x)));
          turns.back() = std::max(turns.back(), ((*quadratic.normal)(x) - (*circle.normal)(x)).norm());
        }
    }
    fmt::print("{}: gap {:.1e} {:.1e} {:.1e} {:.1e}, direction {:.1e} {:.1e}\n", name, gaps[0], gaps[1],
               gaps[2], gaps[3], turns[2], turns[3]);
    for (int i = 0; i < 3; ++i) EXPECT_GT(std::log2(gaps[i] / gaps[i + 1]), 2.7) << name;
    if (turns[3] > 0)
    {
      EXPECT_GT(std::log2(turns[2] / turns[3]), 2.7) << name;
    }
  }
}

/// Holds on every level: the polygon leaves no trace.
TEST(Order2, ThePressureIsThatOfTheCircle)
{
  const problem::Surface floor = obstacles(2)[0].second;
  const mesh::Mesh<2> mesh = round_block<2>({12, 12});
  const problem::Contact quadratic = contact_on<2>(mesh, floor, Frictionless());
  const problem::Contact circle = contact_with(floor, Frictionless(), 2);
  for (int level = 0; level <= 3; ++level)
  {
    const auto on = [&](const problem::Contact& contact)
    {
      return level == 0 ? largest_pressure(contact, mesh)
                        : largest_pressure(contact, mesh::refine_uniformly(mesh, level).mesh);
    };
    const double of_quadratic = on(quadratic);
    const double of_circle = on(circle);
    fmt::print("level {}: {:.5f} {:.5f}\n", level, of_quadratic, of_circle);
    EXPECT_NEAR(of_quadratic, of_circle, 2e-3 * of_circle);
  }
}

TEST(Order2, IsCertifiedIn2D)
{
  for (const int p : {1, 2, 3})
    for (const auto& [name, obstacle] : obstacles(2))
    {
      const mesh::Mesh<2> mesh = round_block<2>({3, 3});
      const problem::Contact contact = contact_on<2>(mesh, obstacle, laws()[p - 1]);
      const DiscreteProblem<2> c(mesh::refine_uniformly(mesh, 1).mesh, pressed_on<2>(contact), {.degree = p});
      EXPECT_EQ(c.form.data().effort().unenclosed, 0) << name;
      const double ratio = sound_effectivity(c);
      fmt::print("{}, p = {}: {:.3f}\n", name, p, ratio);
      EXPECT_GE(ratio, 1) << name << ", p = " << p;
      EXPECT_LE(ratio, 8) << name << ", p = " << p;
    }
}

/// Part of a ball, on a floor and on another ball.
TEST(Order2, IsCertifiedIn3D)
{
  const mesh::Mesh<3> mesh = round_block<3>({2, 1, 2});
  const std::vector<problem::Surface> all = {
      obstacles(3)[0].second,
      problem::sphere(std::vector<double>{0.05, -0.6, 0}, 0.6, problem::Positive::outside)};
  for (const problem::Surface& obstacle : all)
  {
    const DiscreteProblem<3> c(mesh::refine_uniformly(mesh, 1).mesh,
                               pressed_on<3>(contact_on<3>(mesh, obstacle, Coulomb(0.3))), {.degree = 1});
    EXPECT_EQ(c.form.data().effort().unenclosed, 0);
    const double ratio = sound_effectivity(c);
    fmt::print("ball: {:.3f}\n", ratio);
    EXPECT_GE(ratio, 1);
    EXPECT_LE(ratio, 8);
  }
}

/// Contact along the normals of the shape itself.
TEST(Order2, TheNormalOfTheShapeIsCertified)
{
  const mesh::Mesh<2> mesh = round_block<2>({3, 3});
  problem::Contact contact(Coulomb(0.3), formula("0.002 + 0.01*x^2"));
  const case_file::QuadraticGeometry<2> geometry{
      .shape = std::make_shared<const mesh::QuadraticSurface<2>>(*mesh.labels().quadratic_facets,
                                                                 std::array{bottom}, Where{})};
  contact.normal = case_file::direction_of_shape(geometry);
  EXPECT_TRUE(contact.normal->is_enclosed());
  const DiscreteProblem<2> c(mesh::refine_uniformly(mesh, 1).mesh, pressed_on<2>(contact), {.degree = 2});
  EXPECT_GE(sound_effectivity(c), 1);
}

/// Without the shape the certificate reports what straight facets leave out; with it, their distance from it.
TEST(Order2, TheCertificateKnowsWhatIsStraightened)
{
  const mesh::Mesh<2> mesh = round_block<2>({4, 4});
  const double half = (std::asin(0.5) - std::asin(0.25)) / 2;
  const double straightened = 1 - std::cos(half);
  const DiscreteProblem<2> without(mesh::refine_uniformly(mesh, 1).mesh,
                                   pressed_on<2>(problem::Contact(Frictionless(), formula("y"))),
                                   {.degree = 1});
  const certify::ContactGeometryFacts facts = certify::contact_geometry(without.form);
  EXPECT_FALSE(facts.has_shape);
  EXPECT_NEAR(facts.straightened, straightened, 0.05 * straightened);
  const DiscreteProblem<2> with(mesh::refine_uniformly(mesh, 1).mesh,
                                pressed_on<2>(contact_on<2>(mesh, obstacles(2)[0].second, Frictionless())),
                                {.degree = 1});
  const certify::ContactGeometryFacts known = certify::contact_geometry(with.form);
  EXPECT_TRUE(known.has_shape);
  EXPECT_EQ(known.straightened, 0);
  EXPECT_NEAR(known.sagitta, straightened, 0.05 * straightened);
}

}  // namespace

}  // namespace tribound::test::order2_cases
