/// The error intervals of solutions of other programs.

#include "tribound/certify/truth/judgement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "support/dimensions.h"
#include "support/distorted_box.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/adapt/level.h"
#include "tribound/certify/truth/solution_error.h"
#include "tribound/certify/truth/their_forces.h"
#include "tribound/fem/nested.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

template <class T>
class JudgementOf : public ::testing::Test
{
};
TYPED_TEST_SUITE(JudgementOf, Dimensions);

/// A function of degree 2 of the coordinates.
template <int dim>
Point<dim> quadratic(const Point<dim>& x)
{
  Point<dim> u = Point<dim>::Constant(0.1 + x[0] * x[1] - 0.3 * x[dim - 1] * x[dim - 1]);
  u[1] += 0.2 * x[0] - 0.7 * x[1] * x[1];
  return u;
}

TYPED_TEST(JudgementOf, OurOwnSolutionHasTheDistanceZero)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  const std::vector<double> u = random_free_vector({std::vector<char>(c.space.n_dofs(), 0), {}}, 1.0, 3);
  certify::ForeignSolution<dim> theirs{.degree = 2, .u = u};
  const io::TensorField<dim> sigma = io::stress_field<dim>(c.problem, c.space, u);
  theirs.stress.resize(static_cast<std::size_t>(c.mesh.n_cells()) * c.space.basis().n_nodes());
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
    sigma.at_nodes(cell, std::span(theirs.stress)
                             .subspan(static_cast<std::size_t>(cell) * c.space.basis().n_nodes(),
                                      c.space.basis().n_nodes()));
  // The stress is continuous in a cell only: its own values at the nodes give it back.
  const certify::Judgement found = certify::judge<dim>(c.problem, c.space, theirs, c.space, u, 0.25);
  EXPECT_LT(found.displacement.distance, 1e-13 * found.energy_norm);
  EXPECT_EQ(found.displacement.error.lower, 0);
  EXPECT_NEAR(found.displacement.error.upper, 0.25, 1e-9);
  ASSERT_TRUE(found.stress);
  EXPECT_LT(found.stress->distance, 1e-12 * found.energy_norm);
  EXPECT_NEAR(found.factor, 1, 1e-12);
  EXPECT_TRUE(found.doubt.empty());
}

/// A known field more: the distance is its energy norm, on any meshes, cell by cell and by regions.
TYPED_TEST(JudgementOf, AKnownFieldMoreIsTheDistance)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  std::vector<double> u = random_free_vector({std::vector<char>(c.space.n_dofs(), 0), {}}, 1.0, 5);
  const std::vector<double> more = interpolate(c.space, quadratic<dim>);
  const certify::ForeignSolution<dim> theirs{.degree = 2, .u = sum(u, 1, more)};
  const double expected = std::sqrt(
      certify::solution_error<dim>(c.problem, c.space, more, c.space, std::vector<double>(more.size(), 0.0))
          .own_energy);
  auto grid = std::make_unique<const adapt::Grid<dim>>(std::move(mesh::bisect<dim>(c.mesh, {}).mesh), 2);
  std::mt19937 random(11);
  for (int level = 0; level < 4; ++level)
  {
    const certify::Judgement found =
        certify::judge<dim>(c.problem, c.space, theirs, grid->space, u, 0.1 * expected);
    EXPECT_NEAR(found.displacement.distance, expected, 1e-11 * expected);
    EXPECT_NEAR(found.displacement.error.lower, 0.9 * expected, 1e-9 * expected);
    EXPECT_NEAR(found.displacement.error.upper, 1.1 * expected, 1e-9 * expected);
    EXPECT_NEAR(norm(found.displacement.cells), expected, 1e-11 * expected);
    std::vector<Index> marked;
    for (Index cell = 0; cell < grid->mesh.n_cells(); ++cell)
      if (random() % 3 == 0) marked.push_back(cell);
    mesh::Bisected<dim> finer = mesh::bisect<dim>(grid->mesh, marked, 1);
    auto next = std::make_unique<const adapt::Grid<dim>>(std::move(finer.mesh), 2);
    u = fem::nested_interpolant<dim>(grid->space, u, finer.parent, next->space);
    grid = std::move(next);
  }
}

TYPED_TEST(JudgementOf, NothingIsWrongByAllOfIt)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  const std::vector<double> u = interpolate(c.space, quadratic<dim>);
  const certify::ForeignSolution<dim> nothing{.degree = 2, .u = std::vector<double>(u.size(), 0.0)};
  const certify::Judgement found = certify::judge<dim>(c.problem, c.space, nothing, c.space, u, 0.01);
  ASSERT_TRUE(found.displacement.relative);
  EXPECT_LE(found.displacement.relative->lower, 1);
  EXPECT_GE(found.displacement.relative->upper, 1);
  EXPECT_NEAR(found.displacement.distance, found.energy_norm, 1e-12 * found.energy_norm);
}

TYPED_TEST(JudgementOf, PowersOfTenAndSignsAreDoubted)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  const std::vector<double> u = interpolate(c.space, quadratic<dim>);
  const auto doubt = [&](double factor)
  {
    std::vector<double> v = u;
    for (double& x : v) x *= factor;
    v[0] += 1e-4 * factor;
    return certify::judge<dim>(c.problem, c.space, {.degree = 2, .u = v}, c.space, u, 0.01).doubt;
  };
  EXPECT_EQ(doubt(1), "");
  EXPECT_EQ(doubt(1.5), "");
  EXPECT_EQ(doubt(-1), "has the other sign");
  EXPECT_EQ(doubt(1e-3), "is 1000 times too small: metres for millimetres?");
  EXPECT_EQ(doubt(1e3), "is 1000 times too large: metres for millimetres?");
  EXPECT_EQ(doubt(-100), "has the other sign and is 100 times too large: metres for millimetres?");
}

TYPED_TEST(JudgementOf, RigidDifferencesAreFound)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(2);
  const std::vector<double> u = interpolate(c.space, quadratic<dim>);
  std::vector<double> v = u;
  const std::vector<Point<dim>> places = c.space.node_points();
  for (std::size_t n = 0; n < places.size(); ++n)
  {
    v[dim * n] += 0.5 - 0.01 * places[n][1];
    v[dim * n + 1] += 0.01 * places[n][0];
  }
  const certify::Judgement found =
      certify::judge<dim>(c.problem, c.space, {.degree = 2, .u = v}, c.space, u, 0.01);
  EXPECT_LT(found.displacement.distance, 1e-12 * found.energy_norm);
  ASSERT_EQ(found.rigid.size(), 1U);
  EXPECT_NEAR(found.rigid[0].rotation.back(), 0.01, 1e-12);
}

/// Forces of a constant stress, and where it pulls.
TYPED_TEST(JudgementOf, ForcesAndTensionOfAStress)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh = []
  {
    if constexpr (dim == 2)
      return mesh::Mesh<2>(block<2>({3, 2}));
    else
      return mesh::Mesh<3>(box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1}));
  }();
  const fem::LagrangeSpace<dim> space(mesh, 2);
  Tensor<dim> sigma = Tensor<dim>::Zero();
  sigma(0, 0) = 3;
  sigma(1, 1) = -2;
  const std::vector<Tensor<dim>> stress(static_cast<std::size_t>(mesh.n_cells()) * space.basis().n_nodes(),
                                        sigma);
  Point<dim> all = Point<dim>::Zero();
  for (const Point<dim>& force : certify::boundary_forces<dim>(space, stress)) all += force;
  EXPECT_LT(all.norm(), 1e-13);
  std::vector<std::size_t> facets(mesh.boundary().size());
  std::iota(facets.begin(), facets.end(), std::size_t{0});
  const certify::Tension found = certify::tension<dim>(space, stress, facets);
  EXPECT_NEAR(found.largest, 3, 1e-14);
  const auto pulled = std::ranges::count_if(mesh.boundary(),
                                            [&](const mesh::BoundaryFacet& facet)
                                            {
                                              const auto normal =
                                                  mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
                                              return std::abs(normal[0]) > 0.9;
                                            });
  EXPECT_EQ(found.n_facets, static_cast<std::size_t>(pulled));
}

}  // namespace

}  // namespace tribound::test
