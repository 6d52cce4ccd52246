/// @file names_test.cpp
/// Names of cells and vertices, and space-filling curves.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "tribound/mesh/cell_name.h"
#include "tribound/mesh/curve.h"

namespace tribound::test
{
namespace
{

using mesh::CellName;
using mesh::VertexName;

TEST(CellName, AscendsAsTheLeavesOfTheForestDo)
{
  const CellName root{.root = 7};
  std::vector<CellName> leaves = {root};
  for (int depth = 0; depth < 70; ++depth)
  {
    const CellName last = leaves.back();
    leaves.back() = last.child(0);
    leaves.push_back(last.child(1));
  }
  EXPECT_TRUE(std::ranges::is_sorted(leaves));
  EXPECT_EQ(std::ranges::adjacent_find(leaves), leaves.end());
  EXPECT_LT(leaves.back(), CellName{.root = 8});
  CellName deepest = root;
  while (deepest.depth < CellName::max_depth) deepest = deepest.child(1);
  EXPECT_EQ(deepest.path[1], ~std::uint64_t{0});
}

TEST(VertexName, OfAMiddleIsThatOfBothSides)
{
  const VertexName<2> a = mesh::vertex_name<2>({0.1, -0.0}, 0);
  const VertexName<2> b = mesh::vertex_name<2>({0.7, 0.2}, 1);
  const VertexName<2> beside_b = mesh::vertex_name<2>({0.7, 0.2}, 2);
  EXPECT_EQ(a, mesh::vertex_name<2>({0.1, 0.0}, 0));
  EXPECT_EQ(mesh::middle(a, b), mesh::middle(b, a));
  EXPECT_NE(mesh::middle(a, b), mesh::middle(a, beside_b));
  EXPECT_EQ(mesh::middle(a, b).position, mesh::middle(a, beside_b).position);
  // A vertex of one body that coincides with an edge midpoint of another.
  EXPECT_NE(mesh::middle(a, b), mesh::vertex_name<2>(mesh::middle(a, b).point(), 3));
  EXPECT_NE(mesh::middle(b, b), mesh::middle(beside_b, beside_b));
}

/// Neighbours along the Hilbert curve are neighbours in space.
template <int dim>
void expect_continuous_curve(int n)
{
  const mesh::Cube<dim> cube{Point<dim>::Zero(), 1.0};
  std::vector<std::pair<std::uint64_t, Point<dim>>> points;
  const int n_points = dim == 2 ? n * n : n * n * n;
  for (int k = 0; k < n_points; ++k)
  {
    Point<dim> x;
    for (int i = 0, rest = k; i < dim; ++i, rest /= n) x[i] = (rest % n + 0.5) / n;
    points.emplace_back(mesh::hilbert_key<dim>(cube, x), x);
  }
  std::ranges::sort(points, {}, [](const auto& p) { return p.first; });
  for (std::size_t k = 1; k < points.size(); ++k)
    EXPECT_NEAR((points[k].second - points[k - 1].second).norm(), 1.0 / n, 1e-12);
}

TEST(Curve, IsContinuous)
{
  expect_continuous_curve<2>(16);
  expect_continuous_curve<3>(8);
}

}  // namespace
}  // namespace tribound::test
