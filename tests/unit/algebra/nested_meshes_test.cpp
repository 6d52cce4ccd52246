/// @file nested_meshes_test.cpp
/// Multigrid on the meshes of successive bisections: inclusions, coarse matrices, and iterations that do not
/// grow.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

/// Meshes nested in each other, refined within `reach` diameters of the edge (in 2D the corner) x = y = 0.
template <int dim>
struct NestedMeshes
{
  NestedMeshes(mesh::MeshData<dim> first, int n_bisections, double reach = 3)
  {
    meshes.emplace_back(std::move(first));
    for (int k = 0; k < n_bisections; ++k)
    {
      mesh::Bisected<dim> finer = mesh::bisect<dim>(meshes.back(), cells_at_edge(meshes.back(), reach));
      meshes.push_back(std::move(finer.mesh));
      parents.push_back(std::move(finer.parent));
    }
  }

  static std::vector<Index> cells_at_edge(const mesh::Mesh<dim>& mesh, double reach)
  {
    std::vector<Index> cells;
    for (Index c = 0; c < mesh.n_cells(); ++c)
    {
      const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
      if (map.origin.template head<2>().norm() < reach * mesh::cell_diameter(mesh, c)) cells.push_back(c);
    }
    return cells;
  }

  /// The mesh with this number of vertices.
  [[nodiscard]] std::size_t number_of(Index n_vertices) const
  {
    const auto with_it =
        std::ranges::find(meshes, n_vertices, [](const mesh::Mesh<dim>& m) { return m.n_vertices(); });
    return with_it - meshes.begin();
  }

  /// A P^1 function of mesh `from`, carried over geometrically to mesh `to`.
  [[nodiscard]] std::vector<double> carried(std::vector<double> u, std::size_t from, std::size_t to) const
  {
    for (std::size_t k = from; k < to; ++k)
      u = fem::nested_interpolant<dim>({meshes[k], 1}, u, parents[k], {meshes[k + 1], 1});
    return u;
  }

  std::vector<mesh::Mesh<dim>> meshes;
  std::vector<std::vector<Index>> parents;  ///< of the cells of all meshes but the first
};

/// P u, or P^T u, for all components.
std::vector<double> apply(const algebra::NodeInterpolation& step, int dim, std::span<const double> u,
                          bool transposed)
{
  const algebra::Triplets& p = step.weights;
  std::vector<double> result(dim * (transposed ? step.n_coarse : step.n_fine), 0.0);
  for (std::size_t k = 0; k < p.values.size(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      const Index row = dim * p.rows[k] + a;
      const Index col = dim * p.cols[k] + a;
      result[transposed ? col : row] += p.values[k] * u[transposed ? row : col];
    }
  return result;
}

template <int dim>
NestedMeshes<dim> some_meshes()
{
  return {renumbered(block<dim>({3, 2}, {2, 1, 2}), 1), dim == 2 ? 9 : 6};
}

template <int dim>
void expect_inclusions_of_meshes(int degree)
{
  const NestedMeshes<dim> nested = some_meshes<dim>();
  const mesh::Mesh<dim>& finest = nested.meshes.back();
  const algebra::NodeHierarchy hierarchy = algebra::node_hierarchy(fem::LagrangeSpace<dim>(finest, degree));
  std::size_t n_of_meshes = 0;
  for (const algebra::NodeInterpolation& step : hierarchy.steps)
  {
    if (step.n_fine > finest.n_vertices()) continue;  // a step between degrees
    ++n_of_meshes;
    EXPECT_LE(3 * step.n_coarse, 2 * step.n_fine);
    const std::size_t from = nested.number_of(step.n_coarse);
    const std::size_t to = nested.number_of(step.n_fine);
    ASSERT_LT(from, to);
    const fem::LagrangeSpace<dim> coarse(nested.meshes[from], 1);
    const std::vector<double> u =
        interpolate(coarse, [](const Point<dim>& x) -> Point<dim> { return (17 * x).array().sin(); });
    EXPECT_LE(distance(apply(step, dim, u, false), nested.carried(u, from, to)), 1e-11 * norm(u));
    EXPECT_EQ(std::ranges::count(step.weights.values, 0.0), 0);
  }
  EXPECT_GE(n_of_meshes, 3U);
  const auto n_coarsest = static_cast<std::size_t>(hierarchy.steps.back().n_coarse);
  ASSERT_EQ(hierarchy.coarsest_coordinates.size(), dim * n_coarsest);
  for (std::size_t v = 0; v < n_coarsest; ++v)
    EXPECT_EQ(hierarchy.coarsest_coordinates[dim * v], finest.vertex(static_cast<Index>(v))[0]);
}

TEST(NestedMeshes, InterpolateAsTheGeometryDoes)
{
  for (const int degree : {1, 2})
  {
    expect_inclusions_of_meshes<2>(degree);
    expect_inclusions_of_meshes<3>(degree);
  }
}

template <int dim>
fem::Constraints unconstrained(const fem::LagrangeSpace<dim>& space)
{
  return {std::vector<char>(space.n_dofs(), 0), std::vector<double>(space.n_dofs(), 0.0)};
}

/// P^T A P is the stiffness of the coarse mesh.
template <int dim>
void expect_coarse_stiffness()
{
  const NestedMeshes<dim> nested = some_meshes<dim>();
  const auto stiffness = [](const mesh::Mesh<dim>& mesh)
  {
    const fem::LagrangeSpace<dim> space(mesh, 1);
    const problem::Problem<dim> problem = ProblemData<dim>{}.on(mesh);
    return entries(contact::stiffness(problem, space, unconstrained(space)));
  };
  const algebra::NodeHierarchy hierarchy =
      algebra::node_hierarchy(fem::LagrangeSpace<dim>(nested.meshes.back(), 1));
  for (const algebra::NodeInterpolation& step : hierarchy.steps)
  {
    const fem::LagrangeSpace<dim> coarse(nested.meshes[nested.number_of(step.n_coarse)], 1);
    const std::vector<double> w = random_free_vector(unconstrained(coarse), 1.0, 3);
    const std::vector<double> fine =
        multiply(stiffness(nested.meshes[nested.number_of(step.n_fine)]), apply(step, dim, w, false));
    const std::vector<double> expected = multiply(stiffness(coarse.mesh()), w);
    EXPECT_LE(distance(apply(step, dim, fine, true), expected), 1e-12 * norm(expected));
  }
}

TEST(NestedMeshes, GiveTheStiffnessOfTheCoarserMesh)
{
  expect_coarse_stiffness<2>();
  expect_coarse_stiffness<3>();
}

/// GMRES iterations to 1e-10 on every mesh.
template <int dim>
std::vector<int> iterations(const NestedMeshes<dim>& nested, const ProblemData<dim>& data, int degree)
{
  std::vector<int> result;
  for (const mesh::Mesh<dim>& mesh : nested.meshes)
  {
    const problem::Problem<dim> problem = data.on(mesh);
    const fem::LagrangeSpace<dim> space(mesh, degree);
    const fem::Constraints constraints = fem::dirichlet(problem, space);
    const algebra::Triplets entries = test::entries(contact::stiffness(problem, space, constraints));
    const algebra::SparseMatrix a(space.n_dofs(), dim, entries);
    const std::vector<double> b = random_free_vector(constraints, 1.0, 2);
    algebra::LinearSolver solver({.method = algebra::LinearMethod::iterative}, space);
    std::vector<double> x(b.size(), 0.0);
    result.push_back(solver.solve(a, b, 1e-10 * norm(b), x).iterations);
    EXPECT_LE(distance(multiply(entries, x), b), 1e-9 * norm(b));
  }
  return result;
}

/// Iterations do not grow with fixed components on sides that meet or a region of very different stiffness.
template <int dim>
void expect_few_iterations(int degree, int n_bisections, int most)
{
  ProblemData<dim> data{.boundaries = {fixed<dim>("left", 0.0, free, free), clamped<dim>("right")}};
  mesh::MeshData<dim> first = block<dim>({6, 3}, {4, 2, 2});
  first.region_names = {"soft", "stiff"};
  for (std::size_t c = 0; c < first.cells.size(); ++c)
    first.regions[c] = std::abs(first.vertices[first.cells[c][0]][0] - 0.8) < 0.4 ? 1 : 0;
  for (const double contrast : {1.0, 1e-4, 1e4})
  {
    SCOPED_TRACE(contrast);
    data.regions = {{.name = "stiff", .material = lame(contrast, 0.3), .body_force = {}}};
    for (const int n : iterations<dim>({first, n_bisections}, data, degree)) EXPECT_LE(n, most);
  }
}

TEST(NestedMeshes, KeepTheIterationsBounded)
{
  expect_few_iterations<2>(1, 9, 35);
  expect_few_iterations<2>(2, 6, 30);
  expect_few_iterations<3>(1, 4, 20);
  expect_few_iterations<3>(2, 2, 30);
}

/// If meshes grow too slowly, there are no steps between them.
TEST(NestedMeshes, LeaveSlowGrowthToAggregation)
{
  const NestedMeshes<2> nested(block<2>({6, 3}), 16);
  const mesh::Mesh<2>& finest = nested.meshes.back();
  ASSERT_GT(3 * nested.meshes[13].n_vertices(), 2 * finest.n_vertices());
  const algebra::NodeHierarchy hierarchy = algebra::node_hierarchy(fem::LagrangeSpace<2>(finest, 1));
  EXPECT_TRUE(hierarchy.steps.empty());
  EXPECT_EQ(hierarchy.coarsest_coordinates.size(), 2U * finest.n_vertices());
}

/// A first mesh too large for a factorisation, below finer meshes and below P^2.
TEST(NestedMeshes, LeaveALargeFirstMeshToAggregation)
{
  const ProblemData<2> data{.boundaries = {clamped<2>("left")}};
  EXPECT_LE(iterations<2>({block<2>({80, 40}), 1, HUGE_VAL}, data, 1).back(), 30);
  EXPECT_LE(iterations<2>({block<2>({80, 40}), 0}, data, 2).back(), 40);
}

}  // namespace

}  // namespace tribound::test
