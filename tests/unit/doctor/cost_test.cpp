/// @file cost_test.cpp
/// Costs: the number of unknowns is exact, the rest grows with it.

#include "doctor/cost.h"

#include <gtest/gtest.h>

#include "fem/space.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

template <int dim>
void expect_costs(const Mesh<dim>& mesh)
{
  const std::vector<CostEstimate> costs = cost_estimates(mesh, {});
  ASSERT_EQ(costs.size(), 4u);
  for (int degree = 1; degree <= 4; ++degree)
  {
    const CostEstimate& cost = costs[degree - 1];
    EXPECT_EQ(cost.degree, degree);
    EXPECT_EQ(cost.dofs, LagrangeSpace<dim>(mesh, degree).n_dofs());
    EXPECT_EQ(cost.method, choose_method({}, dim, static_cast<Index>(cost.dofs)));
    EXPECT_GT(cost.bytes, 1000 * cost.dofs);
    EXPECT_GT(cost.seconds, degree > 1 ? costs[degree - 2].seconds : 0.0);
  }
}

TEST(Cost, OfEveryDegree)
{
  expect_costs<2>(Mesh<2>(box<2>({0, 0}, {1, 1}, {5, 4})));
  expect_costs<3>(Mesh<3>(box<3>({0, 0, 0}, {1, 1, 1}, {3, 4, 5})));
}

TEST(Cost, MultigridNeedsLessMemory)
{
  const Mesh<3> mesh(box<3>({0, 0, 0}, {1, 1, 1}, {3, 3, 3}));
  const auto direct = cost_estimates(mesh, {.method = LinearMethod::direct});
  const auto iterative = cost_estimates(mesh, {.method = LinearMethod::iterative});
  for (int i = 0; i < 4; ++i) EXPECT_LT(iterative[i].bytes, direct[i].bytes);
}

}  // namespace

}  // namespace tribound::test
