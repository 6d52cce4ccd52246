/// Solutions of other programs as functions on our meshes.

#include "tribound/certify/truth/foreign_solution.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "support/dimensions.h"
#include "support/distorted_box.h"
#include "support/fields.h"
#include "support/input_error.h"
#include "support/meshes.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/import/middle_rule.h"
#include "tribound/mesh/import/simplex_nodes.h"

namespace tribound::test
{

namespace
{

using mesh::ElementType;
using mesh::Shape;

template <class T>
class ForeignSolutionOf : public ::testing::Test
{
};
TYPED_TEST_SUITE(ForeignSolutionOf, Dimensions);

template <int dim>
Point<3> in_space(const Point<dim>& x)
{
  Point<3> point = Point<3>::Zero();
  point.template head<dim>() = x;
  return point;
}

template <int dim>
using Field = std::function<Point<dim>(const Point<dim>&)>;

/// A polynomial of this degree with random coefficients.
template <int dim>
Field<dim> polynomial(int degree, std::mt19937& random)
{
  std::vector<std::pair<std::array<int, 3>, Point<dim>>> terms;
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; k <= (dim == 3 ? degree - i - j : 0); ++k)
      {
        Point<dim> coefficient;
        for (double& component : coefficient) component = uniform(random);
        terms.push_back({{i, j, k}, coefficient});
      }
  return [terms](const Point<dim>& x)
  {
    Point<dim> sum = Point<dim>::Zero();
    for (const auto& [powers, coefficient] : terms)
    {
      double product = 1;
      for (int d = 0; d < dim; ++d) product *= std::pow(x[d], powers[d]);
      sum += product * coefficient;
    }
    return sum;
  };
}

template <int dim>
Field<dim> any_quadratic()
{
  std::mt19937 random(1);
  return polynomial<dim>(2, random);
}

/// Where the node of an element is between its corners.
using NodePlace = std::function<std::array<double, 4>(const mesh::NodeIndex&)>;

std::array<double, 4> equidistant(const mesh::NodeIndex& node)
{
  const double order = std::accumulate(node.begin(), node.end(), 0);
  return {node[0] / order, node[1] / order, node[2] / order, node[3] / order};
}

/// The simplices of a mesh as elements of a file, every node once, in an order of its own.
template <int dim>
mesh::ImportedSolution exported(const mesh::Mesh<dim>& mesh, int degree, unsigned seed,
                                const Field<dim>& f = any_quadratic<dim>(),
                                const NodePlace& place_of = equidistant)
{
  const fem::LagrangeSpace<dim> space(mesh, degree);
  const fem::LagrangeBasis<dim>& basis = space.basis();
  std::vector<Index> row(space.n_nodes());
  std::iota(row.begin(), row.end(), 0);
  std::ranges::shuffle(row, std::mt19937(seed));
  mesh::ImportedSolution theirs;
  theirs.mesh.source.file = "theirs.vtu";
  theirs.mesh.nodes.resize(row.size());
  theirs.displacement.resize(row.size());
  mesh::ElementBlock block{{dim == 2 ? Shape::triangle : Shape::tetrahedron, basis.n_nodes()}};
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (const mesh::NodeIndex& node : mesh::simplex_nodes(block.type))
    {
      Point<dim> x = Point<dim>::Zero();
      for (int v = 0; v <= dim; ++v) x += place_of(node)[v] * mesh.vertices()[mesh.cell(c)[v]];
      int i = 0;
      while (!std::ranges::equal(basis.node(i), std::span(node).first(dim + 1))) ++i;
      const Index at = row[space.cell_nodes(c)[i]];
      block.nodes.push_back(at);
      theirs.mesh.nodes[at] = in_space<dim>(x);
      theirs.displacement[at] = in_space<dim>(f(x));
    }
  theirs.mesh.cells.push_back(std::move(block));
  return theirs;
}

/// The same elements, which begin with other corners.
mesh::ElementBlock turned(const mesh::ElementBlock& block, std::span<const int> corner)
{
  mesh::ElementBlock result{block.type};
  const std::vector<mesh::NodeIndex>& nodes = mesh::simplex_nodes(block.type);
  for (std::size_t e = 0; e < block.size(); ++e)
    for (const mesh::NodeIndex& node : nodes)
    {
      mesh::NodeIndex old{};
      for (std::size_t v = 0; v < corner.size(); ++v) old[corner[v]] = node[v];
      result.nodes.push_back(block.element(e)[std::ranges::find(nodes, old) - nodes.begin()]);
    }
  return result;
}

/// The largest difference at random points of all cells.
template <int dim>
double largest_error(const mesh::Mesh<dim>& mesh, const certify::ForeignSolution<dim>& found,
                     const Field<dim>& f, std::mt19937& random)
{
  const fem::LagrangeSpace<dim> space(mesh, found.degree);
  std::exponential_distribution<double> part;
  double largest = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int k = 0; k < 5; ++k)
    {
      Point<dim> y;
      for (double& coordinate : y) coordinate = part(random);
      y /= y.sum() + part(random);
      const fem::Tabulation<dim> table = space.basis().tabulate({&y, 1});
      Point<dim> value = Point<dim>::Zero();
      for (int i = 0; i < table.n_nodes; ++i)
        for (int d = 0; d < dim; ++d)
          value[d] += table.values[i] * found.u[dim * std::size_t(space.cell_nodes(c)[i]) + d];
      largest = std::max(largest, (value - f(mesh::cell_map(mesh, c)(y))).norm());
    }
  return largest;
}

TYPED_TEST(ForeignSolutionOf, SimplicesGiveTheirFunction)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  std::mt19937 random(3);
  for (unsigned seed = 0; seed < 12; ++seed)
    for (int degree = 1; degree <= 4; ++degree)
    {
      const Field<dim> f = polynomial<dim>(degree, random);
      const certify::ForeignSolution<dim> found =
          certify::foreign_solution<dim>(exported<dim>(c.mesh, degree, seed, f), c.mesh);
      EXPECT_EQ(found.degree, degree);
      EXPECT_TRUE(found.is_exact);
      EXPECT_LT(largest_error<dim>(c.mesh, found, f, random), 1e-12);
    }
}

TYPED_TEST(ForeignSolutionOf, CornersMayHaveAnyOrder)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  std::mt19937 random(11);
  for (int degree = 1; degree <= 4; ++degree)
  {
    const Field<dim> f = polynomial<dim>(degree, random);
    mesh::ImportedSolution theirs = exported<dim>(c.mesh, degree, 7, f);
    const mesh::ElementBlock block = theirs.mesh.cells[0];
    std::array<int, dim + 1> corner{};
    std::iota(corner.begin(), corner.end(), 0);
    do
    {
      theirs.mesh.cells[0] = turned(block, corner);
      EXPECT_LT(largest_error<dim>(c.mesh, certify::foreign_solution<dim>(theirs, c.mesh), f, random), 1e-12);
    } while (std::ranges::next_permutation(corner).found);
  }
}

/// The places of nodes of FEniCSx, which only look the same in all cells, and on straight cells only.
TYPED_TEST(ForeignSolutionOf, SimplicesMayHaveNodesThatAreNotEquidistant)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  std::mt19937 random(5);
  const NodePlace drawn_to_corners = [](const mesh::NodeIndex& node)
  {
    std::array<double, 4> lambda{};
    double sum = 0;
    for (std::size_t v = 0; v < lambda.size(); ++v) sum += lambda[v] = std::pow(node[v], 1.3);
    for (double& coordinate : lambda) coordinate /= sum;
    return lambda;
  };
  for (const int degree : {3, 4})
  {
    const Field<dim> f = polynomial<dim>(degree, random);
    mesh::ImportedSolution theirs = exported<dim>(c.mesh, degree, 7, f, drawn_to_corners);
    const certify::ForeignSolution<dim> found = certify::foreign_solution<dim>(theirs, c.mesh);
    EXPECT_EQ(found.degree, degree);
    EXPECT_TRUE(found.is_exact);
    EXPECT_THAT(found.read_as, ::testing::HasSubstr("not equidistant"));
    EXPECT_LT(largest_error<dim>(c.mesh, found, f, random), 1e-12);
    theirs.displacement[theirs.mesh.cells[0].nodes.back()][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(message_of([&] { return certify::foreign_solution<dim>(theirs, c.mesh); }),
                ::testing::HasSubstr(
                    fmt::format("has no displacement at node {}", theirs.mesh.cells[0].nodes.back() + 1)));
  }
}

TYPED_TEST(ForeignSolutionOf, NodesAtOnePlaceHaveNoFunctions)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  const NodePlace in_the_middle = [](const mesh::NodeIndex& node)
  {
    std::array<double, 4> lambda{};
    for (std::size_t v = 0; v < lambda.size(); ++v)
      if (node[v] > 0) lambda[v] = 1.0 / static_cast<double>(4 - std::ranges::count(node, 0));
    return lambda;
  };
  for (const int degree : {3, 4})
  {
    const certify::ForeignSolution<dim> found = certify::foreign_solution<dim>(
        exported<dim>(c.mesh, degree, 7, any_quadratic<dim>(), in_the_middle), c.mesh);
    EXPECT_FALSE(found.is_exact);
    EXPECT_GT(found.curved_distance, 0.01);
  }
}

TYPED_TEST(ForeignSolutionOf, CurvedSimplicesAreSaidToBe)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  const std::array<std::string, 3> words = {"quadratic", "cubic", "quartic"};
  for (int degree = 2; degree <= 4; ++degree)
  {
    mesh::ImportedSolution theirs = exported<dim>(c.mesh, degree, 7);
    theirs.mesh.nodes[theirs.mesh.cells[0].nodes[dim + 1]][1] += 0.01;
    const certify::ForeignSolution<dim> found = certify::foreign_solution<dim>(theirs, c.mesh);
    EXPECT_FALSE(found.is_exact);
    EXPECT_NEAR(found.curved_distance, 0.01, 1e-14);
    EXPECT_THAT(found.read_as, ::testing::HasSubstr("piecewise " + words[degree - 2]));
    EXPECT_THAT(found.read_as, ::testing::HasSubstr("up to 0.01 away"));
  }
}

/// As in files of CalculiX.
TYPED_TEST(ForeignSolutionOf, NodesOfSixDigitsAreFound)
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
    EXPECT_LT(norm(sum(found.u, -1, interpolate(fem::LagrangeSpace<dim>(c.mesh, 2), any_quadratic<dim>()))),
              1e-14);
  }
}

TYPED_TEST(ForeignSolutionOf, PointsGiveTheDegreeOfTheirNumber)
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
      theirs.displacement.push_back(in_space<dim>(any_quadratic<dim>()(x)));
    }
    const certify::ForeignSolution<dim> found = certify::foreign_solution<dim>(theirs, c.mesh);
    EXPECT_EQ(found.degree, degree);
    EXPECT_LT(norm(sum(found.u, -1, interpolate(space, any_quadratic<dim>()))), 1e-14);
  }
}

TYPED_TEST(ForeignSolutionOf, OtherMeshesAreNamed)
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

/// Functions on another mesh, which is larger: the interpolant is the function.
TYPED_TEST(ForeignSolutionOf, OtherMeshesAreInterpolated)
{
  constexpr int dim = TypeParam::value;
  const DiscreteProblem<dim> c = distorted_box<dim>(1);
  mesh::MeshData<dim> data;
  if constexpr (dim == 2)
    data = mesh::box_mesh<2>({.lower = {-0.5, -0.5}, .upper = {3, 2}, .cells = {5, 4}});
  else
    data = box<3>({-0.5, -0.5, -0.5}, {2, 2, 2}, {3, 2, 3});
  const mesh::Mesh<dim> other(std::move(data));
  std::mt19937 random(9);
  for (int degree = 1; degree <= 4; ++degree)
  {
    const Field<dim> f = polynomial<dim>(degree, random);
    const certify::ForeignSolution<dim> found =
        certify::interpolated_solution<dim>(exported<dim>(other, degree, 3, f), c.mesh);
    EXPECT_EQ(found.degree, degree);
    EXPECT_FALSE(found.is_exact);
    EXPECT_LT(largest_error<dim>(c.mesh, found, f, random), 1e-11);
  }
  mesh::ImportedSolution elsewhere = exported<dim>(other, 2, 3);
  for (Point<3>& x : elsewhere.mesh.nodes) x[0] += 10;
  EXPECT_THAT(message_of([&] { return certify::interpolated_solution<dim>(elsewhere, c.mesh); }),
              ::testing::HasSubstr("has no element at"));
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
