/// @file solve_bench.cpp
/// The time of the stages of a contact solution: CPU seconds on one core, compared with MUMPS alone on the
/// same matrix. See bench/README.md.

#include <fmt/format.h>
#include <petscksp.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/clock.h"
#include "tribound/case/resolve.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/import/read.h"
#include "tribound/solve/newton.h"

namespace
{

using namespace tribound;

struct Arguments
{
  std::string case_file;  ///< empty: the block
  int dim = 2;
  int degree = 2;
  int thousand_dofs = 100;
  std::string friction = R"(friction = "tresca", threshold = 0.03)";
  std::string method = "auto";
  std::string package = "auto";
  bool bare = false;
};

void print(const std::string& stage, double seconds, const std::string& remark = "")
{
  fmt::print("{:<34}{:9.3f}  {}\n", stage, seconds, remark);
}

/// Runs `work` and prints its cost; returns its result.
template <class Work>
auto timed(const std::string& stage, Work work)
{
  const double begin = cpu_seconds();
  auto result = work();
  print(stage, cpu_seconds() - begin);
  return result;
}

/// The smallest n such that the box of 2n x n (x n) squares or cubes has the required number of dofs.
int cells_across(int dim, int degree, double n_dofs)
{
  const auto dofs = [&](int n)
  { return dim * (2.0 * degree * n + 1) * (degree * n + 1) * (dim == 3 ? degree * n + 1 : 1); };
  int n = 1;
  while (dofs(n) < n_dofs) ++n;
  return n;
}

/// A block on a rigid floor, fixed on the left, pressed down and pulled to the right: T2D and its 3D
/// analogue, pulled obliquely.
case_file::Config block(const Arguments& a)
{
  const int n = cells_across(a.dim, a.degree, 1e3 * a.thousand_dofs);
  const std::string friction = "boundary.bottom.contact = { " + a.friction + " }\n";
  const std::string common =
      fmt::format("degree = {}\nmaterial = {{ E = 1.0, nu = 0.3 }}\nsolver.method = \"{}\"\n", a.degree,
                  a.method) +
      fmt::format("solver.package = \"{}\"\n", a.package);
  if (a.dim == 2)
    return case_file::parse_config(common +
                                   fmt::format(R"(
mesh.box = {{ lower = [0, 0], upper = [2, 1], cells = [{}, {}] }}
boundary.left.displacement = [0, 0]
boundary.top.traction = [0, -0.1]
boundary.right.traction = [0.04, 0.06]
)",
                                               2 * n, n) +
                                   friction);
  return case_file::parse_config(common +
                                 fmt::format(R"(
mesh.box = {{ lower = [0, 0, 0], upper = [2, 1, 1], cells = [{}, {}, {}] }}
boundary.left.displacement = [0, 0, 0]
boundary.top.traction = [0, -0.1, 0]
boundary.right.traction = [0.04, 0.06, 0.02]
)",
                                             2 * n, n, n) +
                                 friction);
}

/// MUMPS through PETSc and nothing else: the minimal cost of one system.
void bare_mumps(const algebra::SparseMatrix& matrix, std::span<const double> rhs)
{
  const Mat a = matrix.handle();
  Mat factors = nullptr;
  MatFactorInfo info;
  MatFactorInfoInitialize(&info);
  std::vector<double> b(rhs.begin(), rhs.end());
  std::vector<double> x(b.size());
  const auto n = static_cast<PetscInt>(b.size());
  Vec vec_b = nullptr;
  Vec vec_x = nullptr;
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, b.data(), &vec_b);
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x.data(), &vec_x);
  MatGetFactor(a, MATSOLVERMUMPS, MAT_FACTOR_LU, &factors);
  MatMumpsSetIcntl(factors, 6, 0);  // as LinearSolver does
  timed("bare MUMPS: analysis", [&] { return MatLUFactorSymbolic(factors, a, nullptr, nullptr, &info); });
  timed("bare MUMPS: factorisation", [&] { return MatLUFactorNumeric(factors, a, &info); });
  timed("bare MUMPS: forward, backward", [&] { return MatSolve(factors, vec_b, vec_x); });
  PetscInt entries = 0;
  PetscReal flops = 0;
  MatMumpsGetInfog(factors, 29, &entries);
  MatMumpsGetRinfog(factors, 3, &flops);
  fmt::print("    {:.1f} million entries in the factors, {:.2f} Gflop\n",
             entries < 0 ? -entries : entries / 1e6, flops / 1e9);
  VecDestroy(&vec_b);
  VecDestroy(&vec_x);
  MatDestroy(&factors);
}

/// The whole Newton loop, step by step.
template <int dim>
void newton(const contact::NitscheForm<dim>& form, const case_file::Config& config)
{
  fmt::print("\n{:<34}{:>9}  {:>6} {:>9} {:>8} {:>9}\n", "Newton loop", "CPU s", "GMRES", "residual",
             "damping", "new factors");
  const double begin = cpu_seconds();
  double before = begin;
  int factorisations = 0;
  const auto report = [&](const solve::NewtonIterate<dim>& iterate)
  {
    const solve::NewtonStep& step = iterate.step;
    const double now = cpu_seconds();
    print(fmt::format("  step {}{}", step.step, step.step == 1 ? " with all that is made once" : ""),
          now - before,
          fmt::format("{:6} {:9.1e} {:8} {:>9}", step.linear_iterations, step.residual, step.damping,
                      step.factorised ? "yes" : ""));
    before = now;
    factorisations += step.factorised ? 1 : 0;
    return false;
  };
  const solve::NewtonResult<dim> result =
      solve::solve<dim>(form, {}, config.method.newton, config.method.solver, report);
  print("  all", cpu_seconds() - begin,
        fmt::format("{} steps, {} new factors{}", result.steps.size(), factorisations,
                    result.status == solve::NewtonStatus::converged ? "" : ", FAILED"));
}

template <int dim>
void run(const case_file::Config& config, const mesh::Mesh<dim>& mesh, bool bare)
{
  timed("  topology alone", [&] { return mesh::build_topology<dim>(mesh.n_vertices(), mesh.cells()); });
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  const auto space = timed("space", [&] { return fem::LagrangeSpace<dim>(mesh, config.method.degree); });
  const auto form = timed("form: load, contact points",
                          [&] { return contact::NitscheForm<dim>(problem, space, config.method.gamma_0()); });
  fmt::print("    {} cells, {} dofs, {} contact segments\n", mesh.n_cells(), space.n_dofs(),
             form.segments().size());

  const auto entries = [&] { return contact::stiffness(problem, space, form.constraints()); };
  const algebra::SparseRows rows = timed("stiffness: rows", entries);
  const auto matrix = timed("stiffness: PETSc's copy", [&] { return algebra::SparseMatrix(dim, rows); });
  const std::vector<double> u(space.n_dofs(), 0.0);
  const auto contact_entries = [&]
  { return form.contact_tangent(contact::Linearisation::closed_sticking, u); };
  algebra::SparseMatrix contact =
      timed("contact: pattern, once",
            [&] { return algebra::SparseMatrix(space.n_dofs(), dim, contact_entries()); });
  auto tangent = timed("tangent: sum, once", [&] { return algebra::SparseMatrix::sum(matrix, contact); });
  timed("contact: entries, each step",
        [&]
        {
          contact.set_values(contact_entries().values);
          return 0;
        });
  timed("tangent: sum, each step",
        [&]
        {
          tangent.assign_sum(matrix, contact);
          return 0;
        });

  std::vector<double> x(space.n_dofs());
  timed("matrix times vector", [&] { return matrix.multiply(form.load()); });
  timed("traction at contact points", [&] { return form.traction(u); });
  if (bare) bare_mumps(tangent, form.load());
  newton<dim>(form, config);
}

}  // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  CLI::App app("CPU seconds of every stage of a contact solution");
  app.add_option("--case", arguments.case_file, "Any case file instead of the block");
  app.add_option("--dim", arguments.dim, "2 or 3")->check(CLI::Range(2, 3))->capture_default_str();
  app.add_option("--degree", arguments.degree, "p")->check(CLI::Range(1, 4))->capture_default_str();
  app.add_option("--dofs", arguments.thousand_dofs, "Degrees of freedom, in thousands")
      ->capture_default_str();
  app.add_option("--friction", arguments.friction, "Friction law as in a case file")->capture_default_str();
  app.add_option("--method", arguments.method, "auto, direct or iterative")->capture_default_str();
  app.add_option("--package", arguments.package, "auto, mumps or umfpack")->capture_default_str();
  app.add_flag("--bare", arguments.bare, "Also time MUMPS alone");
  CLI11_PARSE(app, argc, argv);

  const algebra::Environment environment;
  try
  {
    const case_file::Config config =
        arguments.case_file.empty() ? block(arguments) : case_file::read_config(arguments.case_file);
    fmt::print("{:<34}{:>9}\n", "Stage", "CPU s");
    const auto any_mesh = timed("mesh: reading, verification", [&] { return mesh::read_mesh(config.mesh); });
    std::visit([&]<int dim>(const mesh::Mesh<dim>& mesh) { run<dim>(config, mesh, arguments.bare); },
               any_mesh);
  }
  catch (const std::exception& error)
  {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
