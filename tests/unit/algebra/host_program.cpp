/// @file host_program.cpp
/// A program that starts MPI and PETSc before it uses the library: it keeps control of both, and of its
/// options. Exit code 0 if all is well.

#include <mpi.h>
#include <petscksp.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "tribound/algebra/linear_solver.h"

namespace
{

int failures = 0;

void expect(bool holds, const char* what)
{
  if (holds) return;
  ++failures;
  std::fprintf(stderr, "not so: %s\n", what);
}

bool has_option(const char* name)
{
  PetscBool found = PETSC_FALSE;
  PetscOptionsHasName(nullptr, nullptr, name, &found);
  return found == PETSC_TRUE;
}

/// A chain of springs with n nodes in the plane.
bool solves_a_system(tribound::algebra::LinearMethod method)
{
  using namespace tribound;
  constexpr int n = 200;
  algebra::Triplets entries;
  std::vector<Point<2>> nodes;
  for (int i = 0; i < 2 * n; ++i)
  {
    if (i % 2 == 0) nodes.emplace_back(i, 0);
    entries.add(i, i, 2.1);
    if (i >= 2) entries.add(i, i - 2, -1);
    if (i + 2 < 2 * n) entries.add(i, i + 2, -1);
  }
  const algebra::SparseMatrix a(2 * n, 2, entries);
  algebra::LinearSolver solver({.method = method}, std::span<const Point<2>>(nodes));
  const std::vector<double> b(2 * n, 0.1);
  std::vector<double> x(2 * n, 0.0);
  solver.solve(a, b, 1e-9, x);
  return std::abs(-x[n - 2] + 2.1 * x[n] - x[n + 2] - 0.1) < 1e-8;
}

}  // namespace

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  PetscInitializeNoArguments();
  PetscOptionsSetValue(nullptr, "-of_the_host", "1");
  for (int time = 0; time < 2; ++time)
  {
    const tribound::algebra::Environment environment;
    expect(solves_a_system(tribound::algebra::LinearMethod::direct), "a direct solution");
    expect(solves_a_system(tribound::algebra::LinearMethod::iterative), "an iterative solution");
  }
  expect(has_option("-of_the_host"), "options of the program stay");
  for (const char* name :
       {"-matptap_via", "-mat_no_inode", "-tribound_pc_gamg_threshold", "-no_signal_handler"})
    expect(!has_option(name), name);
  int sum = 0;
  const int one = 1;
  expect(MPI_Allreduce(&one, &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD) == MPI_SUCCESS && sum == 1,
         "MPI goes on");
  Vec vector = nullptr;
  expect(VecCreateSeq(PETSC_COMM_SELF, 3, &vector) == 0 && VecDestroy(&vector) == 0, "PETSc goes on");
  PetscFinalize();
  MPI_Finalize();
  return failures == 0 ? 0 : 1;
}
