/// Solutions of other programs on our meshes, and the error intervals that follow.

#include "tribound/certify/truth/judgement.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "support/dimensions.h"
#include "support/distorted_box.h"
#include "support/fields.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/adapt/level.h"
#include "tribound/certify/truth/solution_error.h"
#include "tribound/fem/nested.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/import/middle_rule.h"

namespace tribound::test
{

namespace
{

using mesh::ElementType;
using mesh::Shape;

template <class T>
class JudgementOf : public ::testing::Test
{
};
TYPED_TEST_SUITE(JudgementOf, Dimensions);

template <int dim>
Point<3> in_space(const Point<dim>& x)
{
  Point<3> point = Point<3>::Zero();
  point.template head<dim>() = x;
  return point;
}

/// A function of degree 2 of the coordinates.
template <int dim>
Point<dim> quadratic(const Point<dim>& x)
{
  Point<dim> u = Point<dim>::Constant(0.1 + x[0] * x[1] - 0.3 * x[dim - 1] * x[dim - 1]);
  u[1] += 0.2 * x[0] - 0.7 * x[1] * x[1];
  return u;
}

/// The simplices of a mesh as elements of order 1 or 2 of a file, every node once, in an order of its own.
template <int dim>
mesh::ImportedSolution exported(const mesh::Mesh<dim>& mesh, int degree, unsigned seed)
{
  const fem::LagrangeSpace<dim> space(mesh, degree);
  const std::vector<Point<dim>> places = space.node_points();
  std::vector<Index> row(places.size());
  std::iota(row.begin(), row.end(), 0);
  std::ranges::shuffle(row, std::mt19937(seed));
  mesh::ImportedSolution theirs;
  theirs.mesh.source.file = "theirs.vtu";
  theirs.mesh.nodes.resize(places.size());
  theirs.displacement.resize(places.size());
  for (std::size_t n = 0; n < places.size(); ++n)
  {
    theirs.mesh.nodes[row[n]] = in_space<dim>(places[n]);
    theirs.displacement[row[n]] = in_space<dim>(quadratic<dim>(places[n]));
  }
  const Shape shape = dim == 2 ? Shape::triangle : Shape::tetrahedron;
  const mesh::ShapeTable& table = mesh::table_of(shape);
  mesh::ElementBlock block{{shape, space.basis().n_nodes()}};
  const auto add = [&](Index c, int a, int b)
  {
    std::array<int, dim + 1> index{};
    for (int k = 0; k < degree; ++k) ++index[k == 0 ? a : b];
    for (int i = 0; i < space.basis().n_nodes(); ++i)
      if (space.basis().node(i) == index) block.nodes.push_back(row[space.cell_nodes(c)[i]]);
  };
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    for (int v = 0; v <= dim; ++v) add(c, v, v);
    for (int e = 0; e < table.n_edges && degree == 2; ++e) add(c, table.edges[e][0], table.edges[e][1]);
  }
  theirs.mesh.cells.push_back(std::move(block));
  return theirs;
}

template <int dim>
std::vector<double> values(const fem::LagrangeSpace<dim>& space, Point<dim> (*f)(const Point<dim>&))
{
  std::vector<double> u;
  for (const Point<dim>& x : space.node_points())
  {
    const Point<dim> at = f(x);
    u.insert(u.end(), at.begin(), at.end());
  }
  return u;
}

TYPED_TEST(JudgementOf, SimplicesGiveTheirFunction)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  for (const int degree : {1, 2})
  {
    const certify::ForeignSolution<dim> found =
        certify::foreign_solution<dim>(exported<dim>(c.mesh, degree, 7), c.mesh);
    EXPECT_EQ(found.degree, degree);
    EXPECT_TRUE(found.is_exact);
    const fem::LagrangeSpace<dim> space(c.mesh, degree);
    EXPECT_LT(norm(sum(found.u, -1, values<dim>(space, quadratic<dim>))), 1e-14);
  }
}

/// As in files of CalculiX.
TYPED_TEST(JudgementOf, NodesOfSixDigitsAreFound)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  for (const bool has_elements : {true, false})
  {
    mesh::ImportedSolution theirs = exported<dim>(c.mesh, 2, 7);
    if (!has_elements) theirs.mesh.cells.clear();
    for (Point<3>& x : theirs.mesh.nodes)
      for (double& coordinate : x) coordinate = std::stod(fmt::format("{:.5e}", coordinate));
    const certify::ForeignSolution<dim> found = certify::foreign_solution<dim>(theirs, c.mesh);
    EXPECT_EQ(found.degree, 2);
    EXPECT_GT(found.node_distance, 1e-7);
    EXPECT_LT(norm(sum(found.u, -1, values<dim>({c.mesh, 2}, quadratic<dim>))), 1e-14);
  }
}

TYPED_TEST(JudgementOf, PointsGiveTheDegreeOfTheirNumber)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  for (int degree = 1; degree <= 4; ++degree)
  {
    const fem::LagrangeSpace<dim> space(c.mesh, degree);
    mesh::ImportedSolution theirs;
    for (const Point<dim>& x : space.node_points())
    {
      theirs.mesh.nodes.push_back(in_space<dim>(x));
      theirs.displacement.push_back(in_space<dim>(quadratic<dim>(x)));
    }
    const certify::ForeignSolution<dim> found = certify::foreign_solution<dim>(theirs, c.mesh);
    EXPECT_EQ(found.degree, degree);
    EXPECT_LT(norm(sum(found.u, -1, values<dim>(space, quadratic<dim>))), 1e-14);
  }
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
  const std::vector<double> more = values<dim>(c.space, quadratic<dim>);
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
  const std::vector<double> u = values<dim>(c.space, quadratic<dim>);
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
  const std::vector<double> u = values<dim>(c.space, quadratic<dim>);
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
  const std::vector<double> u = values<dim>(c.space, quadratic<dim>);
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

TYPED_TEST(JudgementOf, OtherMeshesAreNamed)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  const mesh::ImportedSolution theirs = exported<dim>(c.mesh, 1, 7);
  const auto said = [&](const auto& change)
  {
    mesh::ImportedSolution other = theirs;
    change(other);
    return message_of([&] { return certify::foreign_solution<dim>(other, c.mesh); });
  };
  using ::testing::HasSubstr;
  const std::string larger = said(
      [](auto& other)
      {
        for (Point<3>& x : other.mesh.nodes) x *= 1000;
      });
  EXPECT_THAT(larger, HasSubstr("theirs.vtu: has no node at"));
  EXPECT_THAT(larger, HasSubstr("1000 times as large"));
  EXPECT_THAT(said(
                  [](auto& other)
                  {
                    for (Point<3>& x : other.mesh.nodes) x[0] += 1;
                  }),
              HasSubstr("shifted by (1"));
  EXPECT_THAT(said(
                  [](auto& other)
                  {
                    std::vector<Point<3>>& nodes = other.mesh.nodes;
                    const std::vector<Index>& first = other.mesh.cells[0].nodes;
                    nodes[first[0]] = nodes[first[1]];
                  }),
              HasSubstr("does not tell two nodes at"));
  EXPECT_THAT(said([](auto& other) { other.displacement[3][1] = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("has no displacement at node 4"));
  EXPECT_THAT(said([](auto& other) { other.mesh.cells[0].nodes.resize(dim + 1); }),
              HasSubstr("has no element with the corners of the cell"));
}

/// Functions of degree 2 on another mesh, which is larger: the interpolant is the function.
TYPED_TEST(JudgementOf, OtherMeshesAreInterpolated)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  mesh::MeshData<dim> data;
  if constexpr (dim == 2)
    data = mesh::box_mesh<2>({.lower = {-0.5, -0.5}, .upper = {3, 2}, .cells = {5, 4}});
  else
    data = box<3>({-0.5, -0.5, -0.5}, {2, 2, 2}, {3, 2, 3});
  const mesh::Mesh<dim> other(std::move(data));
  const certify::ForeignSolution<dim> found =
      certify::interpolated_solution<dim>(exported<dim>(other, 2, 3), c.mesh);
  EXPECT_EQ(found.degree, 2);
  EXPECT_FALSE(found.is_exact);
  const fem::LagrangeSpace<dim> space(c.mesh, 2);
  EXPECT_LT(norm(sum(found.u, -1, values<dim>(space, quadratic<dim>))), 1e-12);
  mesh::ImportedSolution elsewhere = exported<dim>(other, 2, 3);
  for (Point<3>& x : elsewhere.mesh.nodes) x[0] += 10;
  EXPECT_THAT(message_of([&] { return certify::interpolated_solution<dim>(elsewhere, c.mesh); }),
              ::testing::HasSubstr("has no element at"));
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

/// Shape functions of order 2 are exact for polynomials of degree 2, those of order 1 for linear ones, and
/// all for x y z on a cube.
TEST(MiddleRule, ReproducesPolynomials)
{
  const std::array<std::array<double, 3>, 8> cube = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  for (const ElementType type : {ElementType{Shape::hexahedron, 8},
                                 {Shape::hexahedron, 20},
                                 {Shape::quadrilateral, 4},
                                 {Shape::quadrilateral, 8}})
  {
    const mesh::ShapeTable& table = mesh::table_of(type.shape);
    std::vector<std::array<double, 3>> nodes(cube.begin(), cube.begin() + table.n_corners);
    if (mesh::has_middles(type))
      for (int e = 0; e < table.n_edges; ++e)
      {
        std::array<double, 3> middle{};
        for (int d = 0; d < 3; ++d) middle[d] = (cube[table.edges[e][0]][d] + cube[table.edges[e][1]][d]) / 2;
        nodes.push_back(middle);
      }
    const auto f = [&](const std::array<double, 3>& x)
    {
      const double linear = 0.3 + x[0] - 2 * x[1] + 0.7 * x[2];
      return linear + x[0] * x[1] * (1 + x[2]) +
             (mesh::has_middles(type) ? 0.4 * x[0] * x[0] - x[1] * x[1] : 0);
    };
    for (int a = 0; a < table.n_corners; ++a)
      for (int b = 0; b < a; ++b)
      {
        double value = 0;
        double sum = 0;
        for (const auto& [node, weight] : mesh::middle_rule(type, a, b))
        {
          value += weight * f(nodes[node]);
          sum += weight;
        }
        std::array<double, 3> middle{};
        for (int d = 0; d < 3; ++d) middle[d] = (cube[a][d] + cube[b][d]) / 2;
        EXPECT_NEAR(sum, 1, 1e-15);
        EXPECT_NEAR(value, f(middle), 1e-14) << mesh::describe(type) << " " << a << " " << b;
      }
  }
}

}  // namespace

}  // namespace tribound::test
