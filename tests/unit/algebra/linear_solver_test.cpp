/// @file linear_solver_test.cpp
/// One system solved by every method; what is kept from one system to the next.

#include "tribound/algebra/linear_solver.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/base/error.h"

namespace tribound::test
{

namespace
{

/// The stiffness of a clamped block, and a right-hand side with known solution.
template <int dim>
struct System
{
  System()
      : c(block<dim>({8, 4}, {4, 2, 2}), {.boundaries = {clamped<dim>("left")}}, {.degree = 2}),
        entries(test::entries(contact::stiffness(c.problem, c.space, c.form.constraints()))),
        nodes(c.space.node_points()),
        x(random_free_vector(c.form.constraints(), 1.0, 1)),
        b(multiply(entries, x))
  {
  }

  [[nodiscard]] algebra::SparseMatrix matrix() const { return {c.space.n_dofs(), dim, entries}; }
  [[nodiscard]] algebra::LinearSolver solver(const algebra::SolverOptions& config) const
  {
    return algebra::LinearSolver(config, c.space);
  }

  DiscreteProblem<dim> c;
  algebra::Triplets entries;
  std::vector<Point<dim>> nodes;
  std::vector<double> x;
  std::vector<double> b;
};

algebra::SolverOptions direct(algebra::DirectPackage package)
{
  return {.method = algebra::LinearMethod::direct, .package = package};
}

template <int dim>
void expect_solved(const algebra::SolverOptions& config)
{
  const System<dim> system;
  const algebra::SparseMatrix a = system.matrix();
  algebra::LinearSolver solver = system.solver(config);
  EXPECT_EQ(solver.method(), config.method);
  std::vector<double> x(system.x.size(), 0.0);
  const algebra::LinearSolve solve = solver.solve(a, system.b, 1e-11 * norm(system.b), x);
  EXPECT_TRUE(solve.factorised);
  EXPECT_LE(distance(x, system.x), 1e-7 * norm(system.x));
  EXPECT_LE(distance(a.multiply(x), system.b), 1e-10 * norm(system.b));
}

TEST(LinearSolver, MumpsUmfpackAndMultigridAgree)
{
  const algebra::SolverOptions multigrid{.method = algebra::LinearMethod::iterative};
  for (const algebra::SolverOptions& config :
       {direct(algebra::DirectPackage::mumps), direct(algebra::DirectPackage::umfpack),
        direct(algebra::DirectPackage::automatic), multigrid})
  {
    expect_solved<2>(config);
    expect_solved<3>(config);
  }
}

/// Iterations of p-multigrid to 1e-10 on a problem; the solution must be that of the matrix.
template <int dim>
int p_multigrid_iterations(const DiscreteProblem<dim>& c)
{
  const algebra::SparseRows rows = contact::stiffness(c.problem, c.space, c.form.constraints());
  const algebra::SparseMatrix a(dim, rows);
  std::vector<double> exact = random_free_vector(c.form.constraints(), 1.0, 2);
  for (std::size_t i = 0; i < exact.size(); ++i)
    if (c.form.constraints().fixed[i] != 0) exact[i] = 0.5;  // decoupled, but still equations
  const std::vector<double> b = multiply(entries(rows), exact);
  algebra::LinearSolver solver({.method = algebra::LinearMethod::iterative}, c.space);
  std::vector<double> x(exact.size(), 0.0);
  const int iterations = solver.solve(a, b, 1e-10 * norm(b), x).iterations;
  EXPECT_LE(distance(x, exact), 1e-7 * norm(exact));
  return iterations;
}

/// Components fixed on different sides that meet at edges and corners.
template <int dim>
ProblemData<dim> held_by_components()
{
  ProblemData<dim> data{
      .boundaries = {fixed<dim>("left", 0.0, free, free), fixed<dim>("bottom", free, 0.0, free)}};
  if (dim == 3) data.boundaries.push_back(fixed<dim>("front", free, free, 0.0));
  return data;
}

/// The reference simplex; the side opposite vertex i is the i-th of "bottom", "left", "front", "top".
template <int dim>
mesh::MeshData<dim> one_cell()
{
  mesh::MeshData<dim> data;
  data.vertices.assign(dim + 1, Point<dim>::Zero());
  for (int a = 0; a < dim; ++a) data.vertices[a + 1][a] = 1;
  mesh::Cell<dim> cell{};
  for (int v = 0; v <= dim; ++v) cell[v] = v;
  data.cells = {cell};
  data.regions = {0};
  data.region_names = {"cell"};
  data.boundary_names = {"bottom", "left", "front", "top"};
  for (int v = 0; v <= dim; ++v) data.facets.push_back({mesh::facet_vertices(cell, v), v});
  data.boundary_names.resize(dim + 1);
  return data;
}

TEST(LinearSolver, IterationsOfPMultigridHardlyGrowWithTheDegree)
{
  for (const int degree : {2, 3, 4})
  {
    SCOPED_TRACE(degree);
    const adapt::Method method{.degree = degree};
    for (const auto& data : {ProblemData<2>{.boundaries = {clamped<2>("left")}}, held_by_components<2>()})
      EXPECT_LE(p_multigrid_iterations<2>({block<2>({8, 4}), data, method}), 30);
    for (const auto& data : {ProblemData<3>{.boundaries = {clamped<3>("left")}}, held_by_components<3>()})
      EXPECT_LE(p_multigrid_iterations<3>({block<3>({4, 2, 2}), data, method}), 40);
  }
}

/// Every vertex of such meshes may be fixed; P^1 then has only decoupled degrees of freedom.
TEST(LinearSolver, PMultigridTakesTheSmallestMeshes)
{
  for (const int degree : {2, 3, 4})
  {
    SCOPED_TRACE(degree);
    const adapt::Method method{.degree = degree};
    EXPECT_LE(p_multigrid_iterations<2>({one_cell<2>(), held_by_components<2>(), method}), 40);
    EXPECT_LE(p_multigrid_iterations<3>({one_cell<3>(), held_by_components<3>(), method}), 60);
    EXPECT_LE(p_multigrid_iterations<2>(
                  {block<2>({1, 1}), {.boundaries = {clamped<2>("left"), clamped<2>("right")}}, method}),
              40);
    EXPECT_LE(p_multigrid_iterations<3>(
                  {block<3>({1, 1, 1}), {.boundaries = {clamped<3>("left"), clamped<3>("right")}}, method}),
              60);
  }
}

TEST(LinearSolver, OnP1TheSpaceAddsNothingToItsNodes)
{
  const DiscreteProblem<3> c(block<3>({8, 4, 4}), {.boundaries = {clamped<3>("left")}});
  const algebra::SparseMatrix a(3, contact::stiffness(c.problem, c.space, c.form.constraints()));
  const std::vector<double> b = random_free_vector(c.form.constraints(), 1.0, 1);
  const algebra::SolverOptions multigrid{.method = algebra::LinearMethod::iterative};
  const std::vector<Point<3>> nodes = c.space.node_points();
  algebra::LinearSolver of_space(multigrid, c.space);
  algebra::LinearSolver of_nodes(multigrid, std::span<const Point<3>>(nodes));
  std::vector<double> x(b.size(), 0.0);
  std::vector<double> y(b.size(), 0.0);
  EXPECT_EQ(of_space.solve(a, b, 1e-10 * norm(b), x).iterations,
            of_nodes.solve(a, b, 1e-10 * norm(b), y).iterations);
  EXPECT_EQ(x, y);
}

/// The products on the coarser levels follow the values of the matrix.
TEST(LinearSolver, PMultigridIsRenewedWithTheMatrix)
{
  const System<3> system;
  algebra::SparseMatrix a = system.matrix();
  algebra::LinearSolver solver = system.solver({.method = algebra::LinearMethod::iterative});
  std::vector<double> x(system.x.size(), 0.0);
  const int first = solver.solve(a, system.b, 1e-11 * norm(system.b), x).iterations;
  algebra::Triplets entries = system.entries;
  for (double& value : entries.values) value *= 1e8;
  a.set_values(entries.values);
  const std::vector<double> b = multiply(entries, system.x);
  const algebra::LinearSolve again = solver.solve(a, b, 1e-11 * norm(b), x);
  EXPECT_TRUE(again.factorised);
  EXPECT_LE(again.iterations, 2 * first);
  EXPECT_LE(distance(x, system.x), 1e-7 * norm(system.x));
}

/// Springs of several stiffnesses below a block, with all kinds of levels. Iterations are few, and as many
/// whether or not multigrid is told that nothing else changes.
void expect_renewed_by_part(const mesh::MeshData<3>& mesh, int degree)
{
  const DiscreteProblem<3> c(mesh, {.boundaries = {clamped<3>("left")}}, {.degree = degree});
  const algebra::SparseMatrix stiffness(3, contact::stiffness(c.problem, c.space, c.form.constraints()));
  algebra::Triplets springs;
  const std::vector<Point<3>> nodes = c.space.node_points();
  for (Index i = 0; i < static_cast<Index>(nodes.size()); ++i)
    if (nodes[i][1] == 0 && c.form.constraints().fixed[3 * i] == 0)
      for (int a = 0; a < 3; ++a) springs.add(3 * i + a, 3 * i + a, 1.0);
  algebra::SparseMatrix part(c.space.n_dofs(), 3, springs);
  algebra::SparseMatrix a = algebra::SparseMatrix::sum(stiffness, part);
  algebra::LinearSolver told({.method = algebra::LinearMethod::iterative}, c.space);
  algebra::LinearSolver untold({.method = algebra::LinearMethod::iterative}, c.space);
  told.set_changing_part(part);
  const std::vector<double> b = random_free_vector(c.form.constraints(), 1.0, 1);
  for (const double spring : {1e-3, 1e4, 1e-5, 30.0})
  {
    SCOPED_TRACE(spring);
    for (double& value : springs.values) value = spring;
    part.set_values(springs.values);
    a.assign_sum(stiffness, part);
    std::vector<double> x(b.size(), 0.0);
    std::vector<double> y(b.size(), 0.0);
    const algebra::LinearSolve by_part = told.solve(a, b, 1e-10 * norm(b), x);
    const algebra::LinearSolve as_a_whole = untold.solve(a, b, 1e-10 * norm(b), y);
    EXPECT_LE(distance(x, y), 1e-6 * norm(y));
    EXPECT_LE(by_part.iterations, as_a_whole.iterations + 2);
    EXPECT_LE(by_part.iterations, 60);
  }
}

TEST(LinearSolver, MultigridIsRenewedByThePartThatChanges)
{
  expect_renewed_by_part(block<3>({12, 6, 6}), 1);    // aggregation
  expect_renewed_by_part(block<3>({6, 3, 3}), 3);     // by degree down to a factorisation
  expect_renewed_by_part(block<3>({12, 12, 12}), 2);  // by degree down to aggregation
}

TEST(LinearSolver, ADirectSolveTakesOneIteration)
{
  const System<2> system;
  algebra::LinearSolver solver = system.solver(direct(algebra::DirectPackage::mumps));
  std::vector<double> x(system.x.size(), 0.0);
  EXPECT_LE(solver.solve(system.matrix(), system.b, 1e-10 * norm(system.b), x).iterations, 2);
}

TEST(LinearSolver, HalfTheFactorsOfAPositiveDefiniteMatrixWillDo)
{
  const System<3> system;
  const algebra::SparseMatrix a = system.matrix();
  const algebra::SolverOptions config = direct(algebra::DirectPackage::mumps);
  algebra::LinearSolver solver(config, std::span<const Point<3>>(system.nodes),
                               algebra::MatrixKind::positive_definite);
  std::vector<double> x(system.x.size(), 0.0);
  for (int i = 0; i < 2; ++i)
  {
    const algebra::LinearSolve solve = solver.solve(a, system.b, 1e-11 * norm(system.b), x);
    EXPECT_EQ(solve.factorised, i == 0);
    EXPECT_LE(solve.iterations, 2);
    EXPECT_LE(distance(x, system.x), 1e-7 * norm(system.x));
  }
}

/// Systems that change little are solved with old factors, just as accurately.
TEST(LinearSolver, KeepsFactorsForSimilarSystems)
{
  const System<2> system;
  algebra::SparseMatrix a = system.matrix();
  algebra::LinearSolver solver = system.solver(direct(algebra::DirectPackage::mumps));
  std::vector<double> x(system.x.size(), 0.0);
  EXPECT_TRUE(solver.solve(a, system.b, 1e-11 * norm(system.b), x).factorised);

  algebra::Triplets entries = system.entries;
  for (double& value : entries.values) value *= 1.5;
  a.set_values(entries.values);
  const algebra::LinearSolve again = solver.solve(a, system.b, 1e-11 * norm(system.b), x);
  EXPECT_FALSE(again.factorised);
  EXPECT_GE(again.iterations, 1);
  EXPECT_LE(norm(sum(x, -1 / 1.5, system.x)), 1e-8 * norm(system.x));
}

/// Factors of a very different matrix are discarded, and the answer is right.
TEST(LinearSolver, FactorsAnewWhereOldFactorsDoNotHelp)
{
  const System<2> system;
  algebra::SparseMatrix a = system.matrix();
  algebra::LinearSolver solver = system.solver(direct(algebra::DirectPackage::mumps));
  std::vector<double> x(system.x.size(), 0.0);
  (void)solver.solve(a, system.b, 1e-11 * norm(system.b), x);

  algebra::Triplets entries = system.entries;
  for (std::size_t k = 0; k < entries.values.size(); ++k)
    if (entries.rows[k] >= 0 && entries.rows[k] == entries.cols[k])
      entries.values[k] *= entries.rows[k] % 7 == 0 ? 1e3 : 1 + entries.rows[k] % 5;
  a.set_values(entries.values);
  const std::vector<double> b = multiply(entries, system.x);
  EXPECT_TRUE(solver.solve(a, b, 1e-11 * norm(b), x).factorised);
  EXPECT_LE(distance(x, system.x), 1e-8 * norm(system.x));
}

TEST(LinearSolver, ASingularMatrixIsAnError)
{
  const DiscreteProblem<2> floating(box<2>({0, 0}, {1, 1}, {4, 4}), {});
  const algebra::SparseMatrix a(
      2, contact::stiffness(floating.problem, floating.space, floating.form.constraints()));
  const std::vector<Point<2>> nodes = floating.space.node_points();
  const std::vector<double> b(a.size(), 1.0);  // not in the range
  for (const algebra::DirectPackage package :
       {algebra::DirectPackage::mumps, algebra::DirectPackage::umfpack})
  {
    algebra::LinearSolver solver(direct(package), std::span<const Point<2>>(nodes));
    std::vector<double> x(a.size(), 0.0);
    EXPECT_THROW(solver.solve(a, b, 1e-10, x), SolveError);
  }
}

/// One iteration is not enough for multigrid: unless it was requested, a factorisation replaces it from then
/// on.
TEST(LinearSolver, FallsBackToAFactorisationUnlessToldOtherwise)
{
  const System<3> system;
  const algebra::SparseMatrix a = system.matrix();
  const std::span<const Point<3>> nodes(system.nodes);
  std::vector<double> x(system.x.size(), 0.0);
  algebra::LinearSolver automatic({.max_iterations = 1}, nodes, algebra::MatrixKind::general, 0);
  EXPECT_EQ(automatic.method(), algebra::LinearMethod::iterative);
  EXPECT_TRUE(automatic.solve(a, system.b, 1e-11 * norm(system.b), x).fell_back);
  EXPECT_EQ(automatic.method(), algebra::LinearMethod::direct);
  EXPECT_LE(distance(x, system.x), 1e-7 * norm(system.x));
  const algebra::LinearSolve again = automatic.solve(a, system.b, 1e-11 * norm(system.b), x);
  EXPECT_FALSE(again.fell_back);
  EXPECT_FALSE(again.factorised);

  algebra::LinearSolver told({.method = algebra::LinearMethod::iterative, .max_iterations = 1}, nodes);
  EXPECT_THROW(told.solve(a, system.b, 1e-11 * norm(system.b), x), SolveError);
}

TEST(ChooseMethod, DirectUnlessLargeIn3DOrTold)
{
  const algebra::SolverOptions automatic;
  EXPECT_EQ(algebra::choose_method(automatic, 2, 1'000'000), algebra::LinearMethod::direct);
  EXPECT_EQ(algebra::choose_method(automatic, 3, 5'000), algebra::LinearMethod::direct);
  EXPECT_EQ(algebra::choose_method(automatic, 3, 5'001), algebra::LinearMethod::iterative);
  const algebra::SolverOptions told{.method = algebra::LinearMethod::iterative};
  EXPECT_EQ(algebra::choose_method(told, 2, 100), algebra::LinearMethod::iterative);
}

}  // namespace

}  // namespace tribound::test
