/// @file space_test.cpp
/// Global numbering: continuity, number of nodes, Dirichlet values.

#include "tribound/fem/space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/dimensions.h"
#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/base/error.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

using ::testing::HasSubstr;

template <int dim>
mesh::MeshData<dim> grid()
{
  return block<dim>({4, 3}, {3, 2, 2});
}

/// The function with the given nodal values at a point x of a cell.
template <int dim>
double evaluate(const fem::LagrangeSpace<dim>& space, std::span<const double> nodal, Index cell,
                const Point<dim>& x)
{
  const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), cell);
  const std::vector<Point<dim>> xhat{map.inverse_transpose.transpose() * (x - map.origin)};
  const fem::Tabulation<dim> table = space.basis().tabulate(xhat);
  double value = 0;
  for (int i = 0; i < table.n_nodes; ++i) value += nodal[space.cell_nodes(cell)[i]] * table.values_at(0)[i];
  return value;
}

template <class T>
class Space : public ::testing::Test
{
};
TYPED_TEST_SUITE(Space, Dimensions);

TYPED_TEST(Space, FunctionsAreContinuousAcrossFacets)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(4);
  for (int p = 1; p <= 6; ++p)
  {
    const mesh::Mesh<dim> mesh(distorted<dim>(grid<dim>(), p));
    const fem::LagrangeSpace<dim> space(mesh, p);
    std::vector<double> nodal(space.n_nodes());
    for (double& value : nodal) value = uniform(random);

    const mesh::Topology<dim>& topology = mesh.topology();
    int n_interior = 0;
    for (std::size_t f = 0; f < topology.facets.size(); ++f)
    {
      const auto [one, other] = topology.facet_cells[f];
      if (other < 0) continue;
      ++n_interior;
      const auto corners = mesh::points_of(mesh.vertices(), topology.facets[f]);
      for (const Point<dim - 1>& s : rule.points)
      {
        Point<dim> x = (1 - s.sum()) * corners[0];
        for (int j = 1; j < dim; ++j) x += s[j - 1] * corners[j];
        EXPECT_NEAR(evaluate<dim>(space, nodal, one, x), evaluate<dim>(space, nodal, other, x), 1e-11)
            << "facet " << f << ", degree " << p;
      }
    }
    EXPECT_GT(n_interior, 10);
  }
}

TYPED_TEST(Space, InterpolationReproducesPolynomials)
{
  constexpr int dim = TypeParam::value;
  for (int p = 1; p <= 6; ++p)
  {
    const mesh::Mesh<dim> mesh(distorted<dim>(grid<dim>(), 10 + p));
    const fem::LagrangeSpace<dim> space(mesh, p);
    const auto f = [&](const Point<dim>& x)
    { return std::pow(1 + x[0] - 0.5 * x[dim - 1], p) + std::pow(x[1] - 0.3 * x[0], p); };
    std::vector<double> nodal;
    for (const Point<dim>& x : space.node_points()) nodal.push_back(f(x));
    for (Index c = 0; c < mesh.n_cells(); ++c)
      for (const Point<dim>& xhat : fem::quadrature<dim>(3).points)
      {
        const Point<dim> x = mesh::cell_map(mesh, c)(xhat);
        EXPECT_NEAR(evaluate<dim>(space, nodal, c, x), f(x), 1e-11);
      }
  }
}

TYPED_TEST(Space, NumberOfNodesByEulersFormula)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(distorted<dim>(grid<dim>(), 3));
  const Index v = mesh.n_vertices();
  const Index c = mesh.n_cells();
  const Index f = ((dim + 1) * c + static_cast<Index>(mesh.boundary().size())) / 2;
  const Index e = dim == 2 ? v + c - 1 : v + f - c - 1;
  for (int p = 1; p <= 6; ++p)
  {
    const Index inside_triangle = (p - 1) * (p - 2) / 2;
    const Index inside_tetrahedron = (p - 1) * (p - 2) * (p - 3) / 6;
    const Index expected =
        v + (p - 1) * e + (dim == 2 ? c : f) * inside_triangle + (dim == 3 ? c * inside_tetrahedron : 0);
    const fem::LagrangeSpace<dim> space(mesh, p);
    EXPECT_EQ(space.n_nodes(), expected);
    EXPECT_EQ(space.n_dofs(), dim * expected);
  }
}

TYPED_TEST(Space, NodesOfABoxAreAGrid)
{
  constexpr int dim = TypeParam::value;
  const mesh::Mesh<dim> mesh(grid<dim>());
  for (int p = 1; p <= 4; ++p)
    EXPECT_EQ(fem::LagrangeSpace<dim>(mesh, p).n_nodes(),
              dim == 2 ? (4 * p + 1) * (3 * p + 1) : (3 * p + 1) * (2 * p + 1) * (2 * p + 1));
}

/// The constraints that these conditions give on the box of grid().
template <int dim>
fem::Constraints constraints_of(const std::vector<problem::BoundaryCondition<dim>>& boundaries, int p)
{
  const mesh::Mesh<dim> mesh(grid<dim>());
  const ProblemData<dim> data{.boundaries = boundaries};
  return fem::dirichlet(data.on(mesh), fem::LagrangeSpace<dim>(mesh, p));
}

TEST(Dirichlet, FixesExactlyTheNodesOnTheBoundary)
{
  const mesh::Mesh<2> mesh(grid<2>());
  for (int p = 1; p <= 4; ++p)
  {
    const fem::Constraints constraints = constraints_of<2>(
        {fixed<2>("left", formula("1 + y^2"), free), fixed<2>("top", free, formula("x"))}, p);
    const std::vector<Point<2>> points = fem::LagrangeSpace<2>(mesh, p).node_points();
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double x = points[i][0];
      const double y = points[i][1];
      const bool left = std::abs(x) < 1e-12;
      const bool top = std::abs(y - 1) < 1e-12;
      EXPECT_EQ(constraints.fixed[2 * i], left);
      EXPECT_EQ(constraints.fixed[2 * i + 1], top);
      EXPECT_NEAR(constraints.values[2 * i], left ? 1 + y * y : 0, 1e-14);
      EXPECT_NEAR(constraints.values[2 * i + 1], top ? x : 0, 1e-14);
    }
    EXPECT_EQ(std::ranges::count(constraints.fixed, 1), 3 * p + 1 + 4 * p + 1);
  }
}

TEST(Dirichlet, FixesOneComponentOfAFaceIn3D)
{
  for (int p = 1; p <= 3; ++p)
    EXPECT_EQ(std::ranges::count(constraints_of<3>({fixed<3>("left", free, 2, free)}, p).fixed, 1),
              (2 * p + 1) * (2 * p + 1));
}

TEST(Dirichlet, ValuesMayMeetButNotDiffer)
{
  const auto conditions = [](const std::string& top) -> std::vector<problem::BoundaryCondition<2>>
  {
    return {fixed<2>("left", problem::Field("y", {.key = "boundary.left.displacement"}), 0),
            fixed<2>("top", problem::Field(top, {.key = "boundary.top.displacement"}), free)};
  };
  EXPECT_NO_THROW((void)constraints_of<2>(conditions("1 + x"), 2));
  try
  {
    (void)constraints_of<2>(conditions("1.5 + x"), 2);
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(), HasSubstr("boundary."));
    EXPECT_THAT(error.what(), HasSubstr("at the point (0, 1), where boundary"));
    EXPECT_THAT(error.what(), HasSubstr("is 1.5 at"));
    EXPECT_FALSE(error.hint().empty());
  }
}

}  // namespace

}  // namespace tribound::test
