#include "tribound/io/fields/vtk_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace tribound
{
namespace
{

using ::testing::ElementsAre;

TEST(VtkNodes, Curve)
{
  using Node = std::array<int, 2>;
  EXPECT_THAT(io::vtk_nodes<1>(1), ElementsAre(Node{1, 0}, Node{0, 1}));
  EXPECT_THAT(io::vtk_nodes<1>(3), ElementsAre(Node{3, 0}, Node{0, 3}, Node{2, 1}, Node{1, 2}));
}

TEST(VtkNodes, CubicTriangle)
{
  using Node = std::array<int, 3>;
  EXPECT_THAT(io::vtk_nodes<2>(3),
              ElementsAre(Node{3, 0, 0}, Node{0, 3, 0}, Node{0, 0, 3}, Node{2, 1, 0}, Node{1, 2, 0},
                          Node{0, 2, 1}, Node{0, 1, 2}, Node{1, 0, 2}, Node{2, 0, 1}, Node{1, 1, 1}));
}

// The inner nodes of the faces, in the order of vtkLagrangeTetra::ToBarycentricIndex(), whose last coordinate
// belongs to vertex 0.
TEST(VtkNodes, InnerNodesOfTheQuarticTetrahedron)
{
  using Node = std::array<int, 4>;
  const std::vector<Node> nodes = io::vtk_nodes<3>(4);
  ASSERT_EQ(nodes.size(), 35u);
  EXPECT_THAT(std::vector<Node>(nodes.begin() + 22, nodes.end()),
              ElementsAre(Node{2, 1, 0, 1}, Node{1, 2, 0, 1}, Node{1, 1, 0, 2},  //
                          Node{0, 1, 2, 1}, Node{0, 1, 1, 2}, Node{0, 2, 1, 1},  //
                          Node{2, 0, 1, 1}, Node{1, 0, 1, 2}, Node{1, 0, 2, 1},  //
                          Node{2, 1, 1, 0}, Node{1, 1, 2, 0}, Node{1, 2, 1, 0},  //
                          Node{1, 1, 1, 1}));
}

template <int k>
void expect_permutation(int degree)
{
  std::vector<int> order = io::vtk_order<k>(fem::LagrangeBasis<k>(degree));
  std::ranges::sort(order);
  std::vector<int> all(order.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all) << "k = " << k << ", degree " << degree;
  EXPECT_EQ(static_cast<int>(order.size()), fem::LagrangeBasis<k>(degree).n_nodes());
}

TEST(VtkNodes, OrderIsAPermutationOfTheBasis)
{
  for (int degree = 1; degree <= 6; ++degree)
  {
    expect_permutation<1>(degree);
    expect_permutation<2>(degree);
    expect_permutation<3>(degree);
  }
}

}  // namespace
}  // namespace tribound
