/// @file node_hierarchy_test.cpp
/// Inclusions between the spaces of a mesh.

#include "tribound/algebra/node_hierarchy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// A polynomial of this degree.
template <int dim>
double polynomial(const Point<dim>& x, int degree)
{
  return std::pow(1.5 + x[0] - 0.7 * x[dim - 1], degree) + std::pow(0.3 - x[1], degree);
}

template <int dim>
std::vector<double> nodal_values(const fem::LagrangeSpace<dim>& space, int degree)
{
  std::vector<double> values;
  for (const Point<dim>& x : space.node_points()) values.push_back(polynomial<dim>(x, degree));
  return values;
}

/// Each step reproduces the polynomials of the coarser space, and the last space is P^1.
template <int dim>
void expect_inclusions(int degree, const std::vector<int>& degrees)
{
  const mesh::Mesh<dim> mesh(renumbered(block<dim>({3, 2}, {2, 1, 2}), 1));
  const algebra::NodeHierarchy hierarchy = algebra::node_hierarchy(fem::LagrangeSpace<dim>(mesh, degree));
  ASSERT_EQ(hierarchy.steps.size() + 1, degrees.size());
  for (std::size_t k = 0; k < hierarchy.steps.size(); ++k)
  {
    const algebra::NodeInterpolation& step = hierarchy.steps[k];
    const std::vector<double> coarse = nodal_values<dim>({mesh, degrees[k + 1]}, degrees[k + 1]);
    const std::vector<double> fine = nodal_values<dim>({mesh, degrees[k]}, degrees[k + 1]);
    ASSERT_EQ(step.n_coarse, static_cast<Index>(coarse.size()));
    ASSERT_EQ(step.n_fine, static_cast<Index>(fine.size()));
    std::vector<double> values(fine.size(), 0.0);
    for (std::size_t i = 0; i < step.weights.values.size(); ++i)
      values[step.weights.rows[i]] += step.weights.values[i] * coarse[step.weights.cols[i]];
    for (std::size_t i = 0; i < fine.size(); ++i)
      EXPECT_NEAR(values[i], fine[i], 1e-13 * std::abs(fine[i]) + 1e-14);
  }
  EXPECT_EQ(hierarchy.coarsest_coordinates.size(), static_cast<std::size_t>(dim) * mesh.n_vertices());
}

TEST(NodeHierarchy, HalvesTheDegreeByInclusions)
{
  for (const std::vector<int>& degrees : {std::vector{1}, {2, 1}, {3, 2, 1}, {4, 2, 1}})
  {
    expect_inclusions<2>(degrees.front(), degrees);
    expect_inclusions<3>(degrees.front(), degrees);
  }
}

}  // namespace

}  // namespace tribound::test
