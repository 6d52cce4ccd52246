#include "run.h"

#include <fmt/format.h>
#include <chrono>

#include "contact/nitsche.h"
#include "contact/rigid_motion.h"
#include "io/atomic_file.h"
#include "io/contact_line.h"
#include "io/facts.h"
#include "io/report.h"
#include "io/vtu.h"
#include "mesh/gmsh.h"
#include "solve/linear_solver.h"
#include "solve/newton.h"
#include "solve/petsc.h"

namespace tribound
{

namespace
{

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin)
{
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What a run rests on, for the certificate.
std::vector<std::pair<std::string, std::string>> assumptions(const Config& config, LinearMethod method)
{
  return {
      {"quadrature", fmt::format("data, Neumann and contact integrals are exact for polynomials of degree {}",
                                 data_quadrature_degree(config.degree))},
      {"displacement", "prescribed displacements are interpolated at the nodes"},
      {"geometry", "facets are straight"},
      {"linear_solver", method == LinearMethod::direct ? "direct" : "GMRES with multigrid"}};
}

template <int dim>
void write_fields(const OutputConfig& output, const NitscheForm<dim>& form, std::span<const double> u)
{
  write_contact_csv(output.directory / "contact.csv", form, u);
  if (!output.vtu) return;
  write_level_vtu<dim>(output.directory / "level_000.vtu", 0, form.problem(), form.space(), u);
  write_contact_vtu<dim>(output.directory / "contact_000.vtu", 0, form, u);
  write_series(output.directory, 1);
}

template <int dim>
LevelRecord level_record(const NitscheForm<dim>& form, const NewtonResult<dim>& newton)
{
  LevelRecord level;
  level.cells = form.space().mesh().n_cells();
  level.dofs = form.space().n_dofs() - form.constraints().n_fixed();
  for (const NewtonStep& step : newton.steps) level.newton.push_back({step, {}, false});
  if (newton.status == NewtonStatus::converged) level.newton.back().accepted = true;
  level.figures = solution_figures<dim>(form, newton.u, form.traction(newton.u));
  return level;
}

}  // namespace

BuildFacts library_facts()
{
  const AlgebraVersions algebra = algebra_versions();
  BuildFacts build = build_facts();
  build.petsc = algebra.petsc;
  build.mumps = algebra.mumps;
  build.mpi = algebra.mpi;
  build.blas = algebra.blas;
  build.blas_threads = algebra.blas_threads;
  build.gmsh = gmsh_version();
  build.features = {"2D", "3D", "degrees 1-4", "friction: none, Tresca, Coulomb"};
  return build;
}

namespace
{

/// Newton's method; a linear system that cannot be solved leaves a certificate of the failure behind.
template <int dim>
NewtonResult<dim> solve_or_report(const NitscheForm<dim>& form, const Config& config, RunRecord& record,
                                  const Progress& progress)
{
  try
  {
    return solve<dim>(form, {}, config.newton, config.solver, std::cref(progress));
  }
  catch (const SolveError& error)
  {
    record.status = RunStatus::failed;
    record.reason = error.what();
    write_report(config.output.directory, record);
    throw;
  }
}

}  // namespace

template <int dim>
ExitCode run(const Config& config, const Mesh<dim>& mesh, const Progress& progress)
{
  const Clock::time_point begin = Clock::now();
  const Problem<dim> problem(config, mesh.region_names(), mesh.boundary_names());
  const LagrangeSpace<dim> space(mesh, config.degree);
  const NitscheForm<dim> form(problem, space, config.gamma0());  // a(u,v) - (T(u),v)_C - L(v)
  check_rigid_motions<dim>(problem, space, form.load());
  prepare_output_directory(config.output.directory);

  RunRecord record;
  record.facts = case_facts(config, dim);
  record.mesh = mesh_facts<dim>(problem, space, form.constraints());
  record.build = library_facts();
  record.assumptions = assumptions(config, choose_method(config.solver, dim, space.n_dofs()));
  record.not_covered = {"the error of the discretisation: no bound has been computed"};
  print_header(record.facts, record.mesh);
  record.times.emplace_back("setup", seconds_since(begin));

  const Clock::time_point before_newton = Clock::now();
  const NewtonResult<dim> newton = solve_or_report(form, config, record, progress);
  record.levels.push_back(level_record(form, newton));
  LevelRecord& level = record.levels.back();
  level.times.solve = seconds_since(before_newton);
  record.times.emplace_back("solve", level.times.solve);

  const bool converged = newton.status == NewtonStatus::converged;
  record.status = converged ? RunStatus::uncertified : RunStatus::failed;
  record.reason = converged ? "solved on the given mesh; no bound has been computed" : newton.message;
  const Clock::time_point before_output = Clock::now();
  if (converged) write_fields(config.output, form, newton.u);
  record.times.emplace_back("output", seconds_since(before_output));
  level.times.level = seconds_since(begin);
  write_report(config.output.directory, record);
  print_summary(record, config.output.directory.string());
  return converged ? ExitCode::success : ExitCode::failed;
}

template <int dim>
void check(const Config& config, const Mesh<dim>& mesh)
{
  const Problem<dim> problem(config, mesh.region_names(), mesh.boundary_names());
  const LagrangeSpace<dim> space(mesh, config.degree);
  const NitscheForm<dim> form(problem, space, config.gamma0());
  check_rigid_motions<dim>(problem, space, form.load());
  const bool direct = choose_method(config.solver, dim, space.n_dofs()) == LinearMethod::direct;
  print_check(case_facts(config, dim), mesh_facts<dim>(problem, space, form.constraints()),
              direct ? "direct" : "GMRES with multigrid");
}

template ExitCode run(const Config&, const Mesh<2>&, const Progress&);
template ExitCode run(const Config&, const Mesh<3>&, const Progress&);
template void check(const Config&, const Mesh<2>&);
template void check(const Config&, const Mesh<3>&);

}  // namespace tribound
