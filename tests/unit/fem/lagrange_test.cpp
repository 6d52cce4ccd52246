/// @file lagrange_test.cpp
/// The nodal basis on the reference simplex.

#include "tribound/fem/lagrange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "support/dimensions.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

template <class T>
class Lagrange : public ::testing::Test
{
};
TYPED_TEST_SUITE(Lagrange, AllDimensions);

TYPED_TEST(Lagrange, NodesAreThePrincipalLatticeByEntity)
{
  constexpr int k = TypeParam::value;
  for (int p = 1; p <= 6; ++p)
  {
    const fem::LagrangeBasis<k> basis(p);
    ASSERT_EQ(basis.n_nodes(), fem::polynomial_dimension(k, p));
    std::set<std::array<int, k + 1>> seen;
    for (int i = 0; i < basis.n_nodes(); ++i)
    {
      const auto& node = basis.node(i);
      EXPECT_TRUE(seen.insert(node).second);
      EXPECT_EQ(std::accumulate(node.begin(), node.end(), 0), p);
      for (int j = 0; j < k; ++j) EXPECT_DOUBLE_EQ(basis.node_point(i)[j] * p, node[j + 1]);
    }
    for (int v = 0; v <= k; ++v) EXPECT_EQ(basis.node(v)[v], p) << "vertex " << v;
  }
}

TYPED_TEST(Lagrange, OneAtItsNodeZeroAtTheOthers)
{
  constexpr int k = TypeParam::value;
  for (int p = 1; p <= 6; ++p)
  {
    const fem::LagrangeBasis<k> basis(p);
    const fem::Tabulation<k> table = basis.tabulate(basis.node_points());
    ASSERT_EQ(table.n_points, basis.n_nodes());
    ASSERT_EQ(table.n_nodes, basis.n_nodes());
    for (int q = 0; q < table.n_points; ++q)
      for (int i = 0; i < table.n_nodes; ++i) EXPECT_NEAR(table.values_at(q)[i], q == i ? 1 : 0, 1e-12);
  }
}

TYPED_TEST(Lagrange, SumToOneAndGradientsToZero)
{
  constexpr int k = TypeParam::value;
  const std::vector<Point<k>> points = fem::quadrature<k>(7).points;
  for (int p = 1; p <= 6; ++p)
  {
    const fem::Tabulation<k> table = fem::LagrangeBasis<k>(p).tabulate(points);
    for (int q = 0; q < table.n_points; ++q)
    {
      const auto values = table.values_at(q);
      const auto gradients = table.gradients_at(q);
      EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 1, 1e-12);
      const Point<k> zero = Point<k>::Zero();
      EXPECT_LE(std::accumulate(gradients.begin(), gradients.end(), zero).norm(), 1e-11);
    }
  }
}

TYPED_TEST(Lagrange, GradientsAgreeWithDifferences)
{
  constexpr int k = TypeParam::value;
  constexpr double h = 1e-5;
  const std::vector<Point<k>> points = fem::quadrature<k>(5).points;
  for (int p = 1; p <= 4; ++p)
  {
    const fem::LagrangeBasis<k> basis(p);
    const fem::Tabulation<k> table = basis.tabulate(points);
    for (int a = 0; a < k; ++a)
    {
      std::vector<Point<k>> ahead = points;
      std::vector<Point<k>> behind = points;
      for (Point<k>& x : ahead) x[a] += h;
      for (Point<k>& x : behind) x[a] -= h;
      const fem::Tabulation<k> plus = basis.tabulate(ahead);
      const fem::Tabulation<k> minus = basis.tabulate(behind);
      for (std::size_t i = 0; i < table.values.size(); ++i)
        EXPECT_NEAR((plus.values[i] - minus.values[i]) / (2 * h), table.gradients[i][a], 2e-8);
    }
  }
}

template <int dim>
void expect_facet_tables_agree()
{
  const std::vector<Point<dim - 1>> points = fem::quadrature<dim - 1>(5).points;
  for (int p = 1; p <= 4; ++p)
  {
    const fem::LagrangeBasis<dim> basis(p);
    const fem::LagrangeBasis<dim - 1> trace(p);
    const fem::FacetTabulation<dim> facets = fem::tabulate_on_facets<dim>(basis, points);
    const fem::Tabulation<dim - 1> expected = trace.tabulate(points);
    ASSERT_EQ(facets.points.size(), points.size());
    for (int facet = 0; facet <= dim; ++facet)
      for (int q = 0; q < expected.n_points; ++q)
        for (int i = 0; i < basis.n_nodes(); ++i)
        {
          // The trace of a basis function is the facet's basis function with the remaining weights.
          double value = 0;
          for (int j = 0; j < trace.n_nodes(); ++j)
            if (basis.node(i)[facet] == 0 && mesh::facet_vertices(basis.node(i), facet) == trace.node(j))
              value = expected.values_at(q)[j];
          EXPECT_NEAR(facets.on_facet[facet].values_at(q)[i], value, 1e-13);
        }
  }
}

TEST(FacetTabulation, ValuesAreTheTraces)
{
  expect_facet_tables_agree<2>();
  expect_facet_tables_agree<3>();
}

}  // namespace

}  // namespace tribound::test
