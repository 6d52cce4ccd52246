#include "run.h"

#include <array>
#include <atomic>
#include <csignal>
#include <memory>
#include <utility>

#include "adapt/loop.h"
#include "base/clock.h"
#include "contact/rigid_motion.h"
#include "io/atomic_file.h"
#include "io/contact_line.h"
#include "io/report.h"
#include "io/vtu.h"
#include "mesh/gmsh.h"
#include "solve/linear_solver.h"
#include "solve/petsc.h"

namespace tribound
{

namespace
{

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

/// Keeps the record of a run and writes the files, level by level.
template <int dim>
class RunReport
{
 public:
  /// On the first mesh; the run began at `begin`. Throws InputError for a body that can move rigidly, and
  /// where nothing can be written.
  RunReport(const Config& config, const Problem<dim>& problem, const Discretisation<dim>& first,
            Clock::time_point begin);

  /// After every level: fields, tables and a certificate that holds should the program be killed.
  void add(const LevelView<dim>& view);
  /// The last word.
  [[nodiscard]] ExitCode close(const Verdict& verdict);
  /// The same where there is no level at all: leaves a certificate of the failure behind.
  void fail(const std::string& reason);

 private:
  void write_fields(const LevelView<dim>& view) const;

  const OutputConfig& output_;
  RunRecord record_;
};

template <int dim>
RunReport<dim>::RunReport(const Config& config, const Problem<dim>& problem, const Discretisation<dim>& first,
                          Clock::time_point begin)
    : output_(config.output)
{
  const LagrangeSpace<dim>& space = first.space;
  const NitscheForm<dim>& form = first.form;
  check_rigid_motions<dim>(problem, space, form.load());
  prepare_output_directory(output_.directory);
  record_.facts = case_facts(config, dim);
  record_.mesh = mesh_facts<dim>(problem, space, form.constraints());
  record_.build = library_facts();
  record_.tolerance = config.adapt.tolerance;
  record_.statements = statements(form, config.certify.contact_rule);
  record_.statements.assumptions.emplace_back(
      "linear_solver", describe_solver(choose_method(config.solver, dim, space.n_dofs())));
  record_.times = {{"setup", seconds_since(begin)}, {"solve", 0}, {"certify", 0}, {"output", 0}};
  print_header(record_.facts, record_.mesh);
}

template <int dim>
void RunReport<dim>::write_fields(const LevelView<dim>& view) const
{
  const NitscheForm<dim>& form = view.discrete.form;
  write_contact_csv(output_.directory / "contact.csv", form, view.level.u);
  if (!output_.vtu) return;
  const CellComponents components(view.level.estimate);
  const std::array tensors = {equilibrated_stress_field(view.discrete.space, view.level.stress)};
  write_level_vtu<dim>(output_.directory / level_file_name("level", view.number), view.number, form.problem(),
                       view.discrete.space, view.level.u, components.fields(), tensors);
  write_contact_vtu<dim>(output_.directory / level_file_name("contact", view.number), view.number, form,
                         view.level.u);
  write_series(output_.directory, view.number + 1);
}

template <int dim>
void RunReport<dim>::add(const LevelView<dim>& view)
{
  const NitscheForm<dim>& form = view.discrete.form;
  LevelRecord& level = record_.levels.emplace_back();
  level.level = view.number;
  level.cells = view.discrete.mesh.n_cells();
  level.dofs = view.discrete.space.n_dofs() - form.constraints().n_fixed();
  level.newton = view.level.steps;
  level.figures = solution_figures<dim>(form, view.level.u, form.traction(view.level.u));
  level.times.solve = view.level.solve_seconds;
  level.times.certify = view.level.certify_seconds;
  if (view.level.solved()) level.identities = view.level.identities;

  const Clock::time_point before_output = Clock::now();
  if (view.verdict.status == RunStatus::certified || view.verdict.status == RunStatus::budget)
  {
    level.bound = view.level.estimate;
    write_fields(view);
  }
  else  // what violates an identity is no bound, and is not shown as one
    for (CertifiedStep& step : level.newton) step.bound.reset();
  const double output = seconds_since(before_output);
  level.times.level = view.seconds + output;
  record_.times[1].second += level.times.solve;
  record_.times[2].second += view.level.certify_seconds;
  record_.times[3].second += output;
  record_.status = view.verdict.status;
  record_.reason = view.verdict.reason;
  write_report(output_.directory, record_);
  print_level(level);
}

template <int dim>
ExitCode RunReport<dim>::close(const Verdict& verdict)
{
  record_.status = verdict.status;
  record_.reason = verdict.reason;
  write_report(output_.directory, record_);
  print_summary(record_, output_.directory.string());
  return exit_code(verdict.status);
}

template <int dim>
void RunReport<dim>::fail(const std::string& reason)
{
  record_.status = RunStatus::failed;
  record_.reason = reason;
  write_report(output_.directory, record_);
}

/// Set by SIGINT and SIGTERM: the run then ends with the certificate of its last complete level. A second
/// signal ends the program at once.
std::atomic<bool> stop_requested = false;

void request_stop(int signal)
{
  stop_requested = true;
  std::signal(signal, SIG_DFL);
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

template <int dim>
ExitCode run(const Config& config, Mesh<dim> mesh, const Progress& progress)
{
  const Clock::time_point begin = Clock::now();
  const Problem<dim> problem(config, mesh.region_names(), mesh.boundary_names());
  auto first = std::make_unique<Discretisation<dim>>(std::move(mesh), problem, config);
  RunReport<dim> report(config, problem, *first, begin);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  const LoopObserver<dim> observer = {[&](const CertifiedStep& step) { progress(step.step, step.relative); },
                                      [&](const LevelView<dim>& view) { report.add(view); }};
  try
  {
    return report.close(adapt<dim>(problem, config, std::move(first), observer, stop_requested));
  }
  catch (const SolveError& error)
  {
    report.fail(error.what());
    throw;
  }
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

template ExitCode run(const Config&, Mesh<2>, const Progress&);
template ExitCode run(const Config&, Mesh<3>, const Progress&);
template void check(const Config&, const Mesh<2>&);
template void check(const Config&, const Mesh<3>&);

}  // namespace tribound
