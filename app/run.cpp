#include "run.h"

#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "certify/certificate.h"
#include "certify/checks.h"
#include "certify/equilibrate.h"
#include "certify/estimate.h"
#include "contact/elasticity.h"
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

std::string describe_solver(LinearMethod method)
{
  return method == LinearMethod::direct ? "direct" : "GMRES with multigrid";
}

ExitCode exit_code(RunStatus status)
{
  switch (status)
  {
    case RunStatus::certified:
      return ExitCode::success;
    case RunStatus::budget:
      return ExitCode::budget_used_up;
    default:
      return ExitCode::failed;
  }
}

/// The bound of every iterate of Newton's method on one mesh, the stress and the cells of the last.
template <int dim>
class Certifier
{
 public:
  Certifier(const NitscheForm<dim>& form, const CertifyConfig& config, const Progress& progress)
      : form_(form), estimator_(form, config.contact_rule), progress_(progress)
  {
  }

  void operator()(const NewtonIterate<dim>& iterate)
  {
    NewtonRecord& record = steps.emplace_back(NewtonRecord{iterate.step, {}, false});
    if (!std::isfinite(iterate.step.residual)) return;
    const Clock::time_point begin = Clock::now();
    stress = equilibrate<dim>(form_, iterate.u, iterate.traction);
    estimate = estimator_(iterate.u, stress);
    record.bound = estimate;
    const double sigma_norm = stress_norms(form_.problem(), form_.space(), iterate.u).sigma;
    seconds += seconds_since(begin);
    progress_(iterate.step, sigma_norm > 0 ? std::optional(estimate.total_sharp / sigma_norm) : std::nullopt);
  }

  std::vector<NewtonRecord> steps;
  Stress<dim> stress;
  Estimate estimate;
  double seconds = 0;

 private:
  const NitscheForm<dim>& form_;
  Estimator<dim> estimator_;
  const Progress& progress_;
};

/// eta_tot and the components cell by cell, for the VTU file.
class CellComponents
{
 public:
  explicit CellComponents(const Estimate& estimate)
  {
    add("eta_tot", estimate, [](const BoundComponents& cell) { return cell.total_sharp(); });
    for (const auto& [name, member] : component_names)
      add(std::string("eta_") + name, estimate,
          [m = member](const BoundComponents& cell) { return cell.*m; });
  }

  [[nodiscard]] std::vector<CellField> fields() const
  {
    std::vector<CellField> result;
    for (const auto& [name, values] : columns_) result.push_back({name, values});
    return result;
  }

 private:
  template <typename Value>
  void add(std::string name, const Estimate& estimate, const Value& value)
  {
    std::vector<double>& column = columns_.emplace_back(std::move(name), std::vector<double>{}).second;
    column.reserve(estimate.cells.size());
    for (const BoundComponents& cell : estimate.cells) column.push_back(value(cell));
  }

  std::vector<std::pair<std::string, std::vector<double>>> columns_;
};

template <int dim>
void write_fields(const OutputConfig& output, const NitscheForm<dim>& form, std::span<const double> u,
                  const Certifier<dim>& certified)
{
  write_contact_csv(output.directory / "contact.csv", form, u);
  if (!output.vtu) return;
  const CellComponents components(certified.estimate);
  const std::array tensors = {equilibrated_stress_field(form.space(), certified.stress)};
  write_level_vtu<dim>(output.directory / "level_000.vtu", 0, form.problem(), form.space(), u,
                       components.fields(), tensors);
  write_contact_vtu<dim>(output.directory / "contact_000.vtu", 0, form, u);
  write_series(output.directory, 1);
}

/// Takes the result of Newton's method over into a record, and checks and judges it.
template <int dim>
LevelRecord level_record(const NitscheForm<dim>& form, const NewtonResult<dim>& newton,
                         Certifier<dim>& certifier)
{
  LevelRecord level;
  level.cells = form.space().mesh().n_cells();
  level.dofs = form.space().n_dofs() - form.constraints().n_fixed();
  level.newton = certifier.steps;
  level.figures = solution_figures<dim>(form, newton.u, form.traction(newton.u));
  if (newton.status != NewtonStatus::converged) return level;
  level.newton.back().accepted = true;
  const Clock::time_point begin = Clock::now();
  level.bound = certifier.estimate;
  level.identities = check_identities<dim>(form, newton.traction, certifier.stress);
  certifier.seconds += seconds_since(begin);
  return level;
}

/// What violates an identity is no bound, and is not shown as one.
void withdraw_bounds(LevelRecord& level)
{
  level.bound.reset();
  for (NewtonRecord& step : level.newton) step.bound.reset();
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
                                  Certifier<dim>& certifier)
{
  try
  {
    return solve<dim>(form, {}, config.newton, config.solver, std::ref(certifier));
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
  record.tolerance = config.adapt.tolerance;
  record.statements = statements(form, config.certify.contact_rule);
  record.statements.assumptions.emplace_back(
      "linear_solver", describe_solver(choose_method(config.solver, dim, space.n_dofs())));
  print_header(record.facts, record.mesh);
  record.times.emplace_back("setup", seconds_since(begin));

  const Clock::time_point before_newton = Clock::now();
  Certifier<dim> certifier(form, config.certify, progress);
  const NewtonResult<dim> newton = solve_or_report(form, config, record, certifier);
  LevelRecord& level = record.levels.emplace_back(level_record(form, newton, certifier));
  level.times.certify = certifier.seconds;
  level.times.solve = seconds_since(before_newton) - certifier.seconds;
  record.times.emplace_back("solve", level.times.solve);
  record.times.emplace_back("certify", certifier.seconds);

  const Verdict verdict = level.bound ? judge(*level.bound, *level.identities, config.degree,
                                              level.figures.sigma_norm, config.adapt.tolerance)
                                      : Verdict{RunStatus::failed, newton.message};
  record.status = verdict.status;
  record.reason = verdict.reason;
  const Clock::time_point before_output = Clock::now();
  const bool holds = verdict.status == RunStatus::certified || verdict.status == RunStatus::budget;
  if (holds)
    write_fields(config.output, form, newton.u, certifier);
  else
    withdraw_bounds(level);
  record.times.emplace_back("output", seconds_since(before_output));
  level.times.level = seconds_since(begin);
  write_report(config.output.directory, record);
  print_summary(record, config.output.directory.string());
  return exit_code(verdict.status);
}

template <int dim>
void check(const Config& config, const Mesh<dim>& mesh)
{
  const Problem<dim> problem(config, mesh.region_names(), mesh.boundary_names());
  const LagrangeSpace<dim> space(mesh, config.degree);
  const NitscheForm<dim> form(problem, space, config.gamma0());
  check_rigid_motions<dim>(problem, space, form.load());
  print_check(case_facts(config, dim), mesh_facts<dim>(problem, space, form.constraints()),
              describe_solver(choose_method(config.solver, dim, space.n_dofs())));
}

template ExitCode run(const Config&, const Mesh<2>&, const Progress&);
template ExitCode run(const Config&, const Mesh<3>&, const Progress&);
template void check(const Config&, const Mesh<2>&);
template void check(const Config&, const Mesh<3>&);

}  // namespace tribound
