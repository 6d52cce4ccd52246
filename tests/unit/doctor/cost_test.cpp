/// @file cost_test.cpp
/// Costs: the number of unknowns is exact; the other costs grow with it.

#include "tribound/doctor/cost.h"

#include <gtest/gtest.h>

#include <array>

#include "support/meshes.h"
#include "tribound/fem/space.h"

namespace tribound::test
{

namespace
{

template <int dim>
void expect_costs(const mesh::Mesh<dim>& mesh)
{
  const std::vector<doctor::CostEstimate> costs = doctor::cost_estimates(mesh, {});
  ASSERT_EQ(costs.size(), 4u);
  for (int degree = 1; degree <= 4; ++degree)
  {
    const doctor::CostEstimate& cost = costs[degree - 1];
    EXPECT_EQ(cost.degree, degree);
    EXPECT_EQ(cost.dofs, fem::LagrangeSpace<dim>(mesh, degree).n_dofs());
    EXPECT_EQ(cost.method, algebra::choose_method({}, dim, static_cast<Index>(cost.dofs)));
    EXPECT_GT(cost.bytes, 1000 * cost.dofs);
    EXPECT_GT(cost.seconds, degree > 1 ? costs[degree - 2].seconds : 0.0);
  }
}

TEST(Cost, OfEveryDegree)
{
  expect_costs<2>(mesh::Mesh<2>(box<2>({0, 0}, {1, 1}, {5, 4})));
  expect_costs<3>(mesh::Mesh<3>(box<3>({0, 0, 0}, {1, 1, 1}, {3, 4, 5})));
}

TEST(Cost, MultigridNeedsLessMemoryWhereFactorsAreLarge)
{
  const mesh::Mesh<3> mesh(box<3>({0, 0, 0}, {1, 1, 1}, {12, 12, 12}));
  const auto direct = doctor::cost_estimates(mesh, {.method = algebra::LinearMethod::direct});
  const auto iterative = doctor::cost_estimates(mesh, {.method = algebra::LinearMethod::iterative});
  for (int i = 0; i < 4; ++i) EXPECT_LT(iterative[i].bytes, direct[i].bytes);
}

/// Examples that the model was not fitted to (docs/doctor.md), in MB: predicted to within a quarter.
TEST(Cost, MemoryAsMeasured)
{
  struct Run
  {
    std::array<int, 3> cells;
    int degree;
    double measured;
  };
  const algebra::SolverOptions direct = {.method = algebra::LinearMethod::direct};
  for (const auto& [cells, degree, measured] : {Run{{14, 7, 7}, 2, 359}, Run{{20, 10, 10}, 2, 1161}})
  {
    const mesh::Mesh<3> mesh(box<3>({0, 0, 0}, {2, 1, 1}, cells));
    EXPECT_NEAR(doctor::cost_estimates(mesh, direct)[degree - 1].bytes / 1e6, measured, 0.25 * measured);
  }
  const mesh::Mesh<2> plate(box<2>({0, 0}, {0.04, 0.04}, {60, 60}));
  EXPECT_NEAR(doctor::cost_estimates(plate, {})[2].bytes / 1e6, 331, 0.25 * 331);
}

}  // namespace

}  // namespace tribound::test
