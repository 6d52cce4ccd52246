#include "app/command/run.h"

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "app/command/interrupt.h"
#include "app/command/run_history.h"
#include "app/command/run_report.h"
#include "app/console/balance_text.h"
#include "app/console/forecast.h"
#include "app/output_directory.h"
#include "app/program_facts.h"
#include "tribound/adapt/loop.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/base/clock.h"
#include "tribound/base/rank_failure.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/resolve.h"
#include "tribound/contact/nitsche/interface_check.h"
#include "tribound/contact/support/rigid_motion.h"
#include "tribound/doctor/diagnosis.h"
#include "tribound/doctor/findings.h"
#include "tribound/doctor/support_facts.h"
#include "tribound/fem/nested.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::app
{

ExitCode exit_code(certify::RunStatus status)
{
  switch (status)
  {
    case certify::RunStatus::certified:
      return ExitCode::success;
    case certify::RunStatus::budget:
      return ExitCode::budget_used_up;
    default:
      return ExitCode::failed;
  }
}

namespace
{

/// doctor::slides_as_a_whole() as far as this rank has a whole mesh; elsewhere nothing slides.
template <int dim>
std::vector<bool> slides_as_a_whole(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                    const mesh::Mesh<dim>* whole)
{
  return mesh.ranks().together(
      [&]
      {
        const mesh::Mesh<dim>* known = mesh.partition() ? whole : &mesh;
        return known ? doctor::slides_as_a_whole<dim>(problem, *known)
                     : std::vector<bool>(problem.boundaries().size(), false);
      });
}

template <int dim>
std::unique_ptr<adapt::Levels<dim>> first_level(const case_file::Config& config,
                                                const problem::Problem<dim>& problem, mesh::Mesh<dim> mesh,
                                                const std::optional<Restart>& restart,
                                                const std::atomic<bool>& stop,
                                                std::shared_ptr<const mesh::Mesh<dim>> whole)
{
  contact::DataAccuracy accuracy;
  if (restart) accuracy.absolute = restart->facts.start.accuracy;
  auto first =
      std::make_unique<adapt::Discretisation<dim>>(std::move(mesh), problem, config.method, accuracy);
  if (first->mesh.ranks().any(stop))
    throw SolveError("interrupted before anything was solved; nothing is written");
  if (!restart)
    return std::make_unique<adapt::Levels<dim>>(problem, config.method, config.adapt.tolerance,
                                                std::move(first), &stop, std::move(whole));
  std::vector<double> u = fem::from_cell_values<dim>(first->space, restart->cells, restart->values);
  return std::make_unique<adapt::Levels<dim>>(problem, config.method, config.adapt.tolerance,
                                              std::move(first), restart->facts.start, std::move(u), &stop,
                                              std::move(whole));
}

}  // namespace

template <int dim>
ExitCode run(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress,
             std::shared_ptr<const mesh::Mesh<dim>> whole, const std::optional<Restart>& restart)
{
  const Clock::time_point begin = Clock::now();
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  const std::atomic<bool>& stop = stop_on_signals();
  const std::vector<bool> slides = slides_as_a_whole<dim>(problem, mesh, whole.get());
  if (config.history)
    return run_history<dim>(config, problem, std::move(mesh), slides, stop, progress, std::move(whole),
                            restart, begin);
  auto quantities = case_file::resolve_quantities<dim>(config, problem, mesh.boundary_names());
  const std::unique_ptr<adapt::Levels<dim>> levels =
      first_level<dim>(config, problem, std::move(mesh), restart, stop, std::move(whole));
  RunReport<dim> report(config, problem, levels->discrete(), slides, begin,
                        progress.quiet() ? Printed::verdict : Printed::everything,
                        restart ? &restart->facts.earlier : nullptr);
  levels->ask_for(config.adapt.bars, std::move(quantities));
  adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(config.adapt, &stop);
  strategy.observer = {[&](const adapt::CertifiedStep& step) { progress(step.step, step.relative); },
                       [&](const adapt::LevelView<dim>& view)
                       {
                         report.add(view);
                         const std::string forecast = forecast_text(report.record(), config.adapt.max_dofs);
                         if (!forecast.empty()) progress.stage(forecast);
                       },
                       [&](const adapt::Levels<dim>& next)
                       {
                         if (config.output.checkpoints == case_file::Checkpoints::none) return;
                         try
                         {
                           report.write_checkpoint(next);
                         }
                         catch (const io::WriteError& error)
                         {
                           require_all_failed(next.discrete().mesh.ranks(), error.what());
                           report.write_what_holds();
                           throw;
                         }
                       }};
  try
  {
    return report.close(adapt::adapt(*levels, strategy));
  }
  catch (const SolveError& error)
  {
    require_all_failed(levels->discrete().mesh.ranks(), error.what());
    report.fail(error.what());
    throw;
  }
  catch (const InputError& error)  // data that are not valid on a finer mesh: the levels before hold
  {
    require_all_failed(levels->discrete().mesh.ranks(), error.what());
    report.write_what_holds();
    throw;
  }
}

template <int dim>
void check(const case_file::Config& config, const mesh::Mesh<dim>& mesh, bool as_json)
{
  problem::Problem<dim> problem(case_file::resolve(config, mesh));
  if (config.history) problem = problem.at(config.history->program.targets.front());
  (void)moment_point<dim>(config.output, mesh);  // throws where it has the wrong length
  (void)case_file::resolve_quantities<dim>(config, problem, mesh.boundary_names());
  const fem::LagrangeSpace<dim> space(mesh, config.method.degree);
  contact::NitscheForm<dim> form(problem, space, config.method.gamma_0());
  if (auto history = contact::history_at_first(form)) form.set_history(std::move(history));
  contact::check_interfaces(form);
  contact::check_rigid_motions(form);
  require_mesh_elsewhere(config);
  try_output_directory(config.output.directory);
  print_check(case_file::case_facts(config, dim), io::mesh_facts<dim>(problem, space, form.constraints()),
              describe_solver(solve::choose_method(form, config.method.solver, true)),
              doctor::findings(doctor::diagnose(form, config.method, config.adapt)), as_json);
}

template ExitCode run(const case_file::Config&, mesh::Mesh<2>, const Progress&,
                      std::shared_ptr<const mesh::Mesh<2>>, const std::optional<Restart>&);
template ExitCode run(const case_file::Config&, mesh::Mesh<3>, const Progress&,
                      std::shared_ptr<const mesh::Mesh<3>>, const std::optional<Restart>&);
template void check(const case_file::Config&, const mesh::Mesh<2>&, bool);
template void check(const case_file::Config&, const mesh::Mesh<3>&, bool);

}  // namespace tribound::app
