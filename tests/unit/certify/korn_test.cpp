/// @file korn_test.cpp
/// Korn's constant of bodies against that of linear finite elements, which is smaller.

#include "tribound/certify/bound/korn.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/base/dense_factors.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

/// sup ||w|| / ||eps(w)|| over continuous functions of degree 1 that vanish where the boundaries fix them.
template <int dim>
double of_linear_elements(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  const auto n = static_cast<Index>(mesh.vertices().size());
  std::vector<char> fixed(dim * n, 0);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      for (int a = 0; a < dim; ++a)
        if (problem.boundary(facet.tag).fixes(a)) fixed[dim * v + a] = 1;
  std::vector<Index> number(dim * n, -1);
  Index n_free = 0;
  for (Index i = 0; i < dim * n; ++i)
    if (!fixed[i]) number[i] = n_free++;
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(n_free, n_free);
  Eigen::MatrixXd mass = energy;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    std::array<Point<dim>, dim + 1> gradients;
    gradients[0] = -map.inverse_transpose.rowwise().sum();
    for (int i = 0; i < dim; ++i) gradients[i + 1] = map.inverse_transpose.col(i);
    const auto cell = mesh.cell(c);
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        for (int a = 0; a < dim; ++a)
          for (int b = 0; b < dim; ++b)
          {
            const Index row = number[dim * cell[i] + a];
            const Index column = number[dim * cell[j] + b];
            if (row < 0 || column < 0) continue;
            double product = gradients[i][b] * gradients[j][a];
            if (a == b) product += gradients[i].dot(gradients[j]);
            energy(row, column) += map.measure() * product / 2;
            if (a == b) mass(row, column) += map.measure() * (i == j ? 2 : 1) / ((dim + 1) * (dim + 2));
          }
  }
  const Eigen::MatrixXd lower = CholeskyFactors(energy).lower();
  const Eigen::MatrixXd half = solve_lower(lower, mass);
  return std::sqrt(symmetric_eigen(solve_lower(lower, half.transpose())).values[n_free - 1]);
}

/// Boundaries with a load for which K is needed.
template <int dim>
problem::Problem<dim> with_sine(const mesh::Mesh<dim>& mesh,
                                std::vector<problem::BoundaryCondition<dim>> boundaries)
{
  ProblemData<dim> data{.boundaries = std::move(boundaries)};
  data.body_force[0] = formula("sin(x)");
  return data.on(mesh);
}

template <int dim>
problem::BoundaryCondition<dim> roller(const char* name, int component)
{
  problem::BoundaryCondition<dim> condition;
  condition.name = name;
  condition.displacement[component] = problem::Field(0.0);
  return condition;
}

template <int dim>
void expect_above_linear_elements(const char* name, const mesh::Mesh<dim>& mesh,
                                  const std::vector<problem::BoundaryCondition<dim>>& boundaries)
{
  const problem::Problem<dim> problem = with_sine<dim>(mesh, boundaries);
  const double found = certify::korn_constant(problem, mesh);
  const double linear = of_linear_elements(problem, mesh);
  fmt::print("{:<10} {}D: {:.4g}, of linear elements {:.4g}\n", name, dim, found, linear);
  EXPECT_GT(found, linear);
  EXPECT_LT(found, 1e5 * linear);
}

TEST(KornConstant, IsAboveThatOfLinearElements)
{
  const mesh::Mesh<2> flat(block<2>({6, 3}));
  expect_above_linear_elements<2>("clamped", flat, {clamped<2>("left")});
  expect_above_linear_elements<2>("rollers", flat, {roller<2>("left", 0), roller<2>("bottom", 1)});
  const mesh::Mesh<3> solid(block<3>({3, 2, 1}));
  expect_above_linear_elements<3>("clamped", solid, {clamped<3>("left")});
  expect_above_linear_elements<3>("rollers", solid,
                                  {roller<3>("left", 0), roller<3>("bottom", 1), roller<3>("front", 2)});
  const mesh::Mesh<3> flattened(
      mapped<3>(block<3>({3, 2, 1}), [](const Point<3>& x) { return Point<3>(x[0], 0.1 * x[1], x[2]); }));
  expect_above_linear_elements<3>("flat", flattened, {clamped<3>("left")});
}

TEST(KornConstant, IsInfiniteWhereABodyMayMove)
{
  const mesh::Mesh<2> mesh(block<2>({4, 2}));
  EXPECT_TRUE(std::isinf(certify::korn_constant(with_sine<2>(mesh, {roller<2>("left", 0)}), mesh)));
  EXPECT_TRUE(std::isinf(certify::korn_constant(with_sine<2>(mesh, {}), mesh)));
}

TEST(KornConstant, IsOnlyComputedWhereLoadsNeedIt)
{
  const mesh::Mesh<2> mesh(block<2>({4, 2}));
  ProblemData<2> data{.boundaries = {clamped<2>("left")}};
  data.body_force[0] = formula("x^2*y");
  EXPECT_EQ(certify::korn_constant(data.on(mesh), mesh), 0);
}

}  // namespace

}  // namespace tribound::test
