#include "app/command/run.h"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/command/run_report.h"
#include "app/command/with_case.h"
#include "app/console/text.h"
#include "app/output_directory.h"
#include "tribound/adapt/history_check.h"
#include "tribound/adapt/loop.h"
#include "tribound/adapt/transfer.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/case/probe_reader.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/resolve.h"
#include "tribound/contact/nitsche/interface_check.h"
#include "tribound/contact/support/rigid_motion.h"
#include "tribound/doctor/diagnosis.h"
#include "tribound/doctor/findings.h"
#include "tribound/doctor/path_facts.h"
#include "tribound/doctor/support_facts.h"
#include "tribound/fem/nested.h"
#include "tribound/io/record/run_statements.h"
#include "tribound/io/state/path_checkpoint.h"

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

/// doctor::slides_as_a_whole() if this rank has a whole mesh; otherwise nothing slides.
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
                                                const Restart* restart, const std::atomic<bool>& stop,
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

/// One observer after the other; the second may be empty.
adapt::StepObserver both(const Progress& first, const adapt::StepObserver& second, const Ranks& ranks)
{
  if (!second) return first;
  return [first, second, ranks](const adapt::CertifiedStep& step)
  {
    first(step);
    ranks.together([&] { second(step); });
  };
}

Printed printed(const Progress& progress, const RunHooks& hooks)
{
  if (hooks.is_part) return progress.quiet() ? Printed::nothing : Printed::levels;
  return progress.quiet() ? Printed::verdict : Printed::everything;
}

/// The strategy of the case, with the marking and the stopping rule of the hooks.
template <int dim>
adapt::Strategy<dim> make_strategy(const case_file::Config& config, const std::atomic<bool>& stop,
                                   const RunHooks& all_hooks)
{
  const LoopHooks<dim>& hooks = all_hooks.of<dim>();
  const auto kept = [](const adapt::LevelView<dim>& view)
  { return std::make_shared<const KeptLevel<dim>>(view); };
  adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(config.adapt, &stop);
  if (hooks.mark)
    strategy.mark = [&hooks, kept](const adapt::LevelView<dim>& view)
    { return view.discrete.mesh.ranks().together([&] { return hooks.mark(kept(view)); }); };
  if (hooks.stop)
    strategy.stop = [&hooks, kept, of_case = std::move(strategy.stop)](const adapt::LevelView<dim>& view)
    {
      std::string why = of_case(view);
      if (!why.empty()) return why;
      const Ranks& ranks = view.discrete.mesh.ranks();
      why = ranks.together([&] { return hooks.stop(kept(view)); });
      const bool stops = ranks.any(!why.empty());
      return stops && why.empty() ? "the stopping rule of another process is met" : why;
    };
  return strategy;
}

/// Refines the mesh level by level.
template <int dim>
certify::Verdict go_through_levels(const case_file::Config& config, adapt::Levels<dim>& levels,
                                   const std::atomic<bool>& stop, const Progress& progress,
                                   const RunHooks& hooks, RunReport<dim>& report)
{
  adapt::Strategy<dim> strategy = make_strategy<dim>(config, stop, hooks);
  strategy.observer.step = both(progress, hooks.step, levels.discrete().mesh.ranks());
  strategy.observer.level = [&](const adapt::LevelView<dim>& view)
  {
    report.add(view);
    const std::string forecast = forecast_text(report.record(), config.adapt.max_dofs);
    if (!forecast.empty()) progress.stage(forecast);
  };
  if (config.output.checkpoints != case_file::Checkpoints::none)
    strategy.observer.refined = [&](const adapt::Levels<dim>& next) { report.write_checkpoint(next); };
  return adapt::adapt(levels, strategy);
}

/// Follows a completed path once more, with half the steps on a finer mesh than that of its last step;
/// `grid`: for a run that had no step left to do.
template <int dim>
void check_history(const case_file::Config& config, const problem::Problem<dim>& problem,
                   std::shared_ptr<const adapt::Grid<dim>> grid, const std::atomic<bool>& stop,
                   const Progress& progress, RunReport<dim>& report)
{
  if (report.has_check()) return;
  if (report.last_grid()) grid = report.last_grid();
  io::HistoryCheck check;
  const auto begins = [&](int, const adapt::Grid<dim>& finer)
  {
    check.cells = finer.mesh.n_global_cells();
    report.print_mesh("check", finer);
  };
  const auto add = [&](const adapt::LoadStep<dim>& step)
  {
    check.last = io::load_step_record<dim>(step, check.last ? &*check.last : nullptr);
    check.steps = step.number;
    io::LevelRecord shown;
    shown.level = step.number;
    shown.newton = step.level.steps;
    shown.times.level = step.seconds;
    shown.load_step = check.last;
    report.print_level(shown);
  };
  if (grid->mesh.ranks().any(stop))
    check.end.failure = "interrupted";
  else
    check.end = adapt::follow_finely<dim>(*grid, problem, config.method, config.history->program,
                                          {.newton = progress, .begins = begins, .step = add}, &stop);
  report.add_check(std::move(check));
}

/// Follows the load steps on meshes that become fine enough for all of them.
template <int dim>
certify::Verdict go_along_path(const case_file::Config& config, std::unique_ptr<adapt::LoadPath<dim>> path,
                               const std::atomic<bool>& stop, const Progress& progress, const RunHooks& hooks,
                               std::shared_ptr<const adapt::Grid<dim>> grid, const Restart* restart,
                               RunReport<dim>& report)
{
  std::optional<adapt::ReplayState<dim>> from;
  if (restart)
    from = io::from_checkpoint<dim>(restart->facts, path->grid().space, restart->cells, restart->values,
                                    restart->points);
  const adapt::ReplayState<dim>* state = from ? &*from : nullptr;
  const adapt::Strategy<dim> strategy = make_strategy<dim>(config, stop, hooks);
  adapt::ReplayObserver<dim> observer =
      report.path_observer(both(progress, hooks.step, path->grid().mesh.ranks()));
  if (hooks.pass)
    observer.complete = [&hooks, of_report = std::move(observer.complete)](const adapt::PassView<dim>& pass)
    {
      of_report(pass);
      hooks.pass();
    };
  const problem::Problem<dim>& problem = path->problem();
  const adapt::PathProgram& program = config.history->program;
  certify::Verdict verdict = config.history->refine == case_file::Refine::transfer
                                 ? adapt::transfer<dim>(*path, program, strategy, observer, state)
                                 : adapt::replay<dim>(std::move(path), program, strategy, observer, state);
  path.reset();  // its factors take memory
  if (!config.history->check || !certify::is_bound(verdict.status)) return verdict;
  report.end(verdict);  // should the program be killed during the check, nothing else is lost
  check_history<dim>(config, problem, std::move(grid), stop, progress, report);
  return verdict;
}

}  // namespace

template <int dim>
ExitCode run(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress,
             const RunHooks& hooks, std::shared_ptr<const mesh::Mesh<dim>> whole, const Restart* restart)
{
  const Clock::time_point begin = Clock::now();
  const auto owned_problem = std::make_shared<const problem::Problem<dim>>(case_file::resolve(config, mesh));
  const problem::Problem<dim>& problem = *owned_problem;
  const std::atomic<bool>& stop = stop_on_signals();
  const std::vector<bool> slides = slides_as_a_whole<dim>(problem, mesh, whole.get());
  const auto report_from = [&](const adapt::Discretisation<dim>& first, const auto& work)
  {
    RunReport<dim> report(config, problem, first, slides, begin, printed(progress, hooks), restart);
    report.watch(owned_problem, hooks.of<dim>().level);
    try
    {
      return report.close(work(report));
    }
    catch (const SolveError& error)
    {
      report.fail(error.what());
      throw;
    }
    catch (const InputError& error)  // data that are invalid on a finer mesh, or at a later t
    {
      report.fail(error.what());
      throw;
    }
  };
  auto quantities = case_file::resolve_quantities<dim>(config, problem, mesh.boundary_names());
  if (config.history)
  {
    auto path = std::make_unique<adapt::LoadPath<dim>>(
        problem, config.method, adapt::PathOptions{.tolerance = config.adapt.tolerance}, std::move(mesh),
        &stop, std::move(whole));
    path->ask_for(config.adapt.bars, std::move(quantities));
    const adapt::Discretisation<dim>& first = path->prepare(config.history->program.targets.front());
    return report_from(first,
                       [&](RunReport<dim>& report)
                       {
                         return go_along_path<dim>(config, std::move(path), stop, progress, hooks,
                                                   restart ? first.grid : nullptr, restart, report);
                       });
  }
  const std::unique_ptr<adapt::Levels<dim>> levels =
      first_level<dim>(config, problem, std::move(mesh), restart, stop, std::move(whole));
  levels->ask_for(config.adapt.bars, std::move(quantities));
  return report_from(levels->discrete(), [&](RunReport<dim>& report)
                     { return go_through_levels<dim>(config, *levels, stop, progress, hooks, report); });
}

template ExitCode run(const case_file::Config&, mesh::Mesh<2>, const Progress&, const RunHooks&,
                      std::shared_ptr<const mesh::Mesh<2>>, const Restart*);
template ExitCode run(const case_file::Config&, mesh::Mesh<3>, const Progress&, const RunHooks&,
                      std::shared_ptr<const mesh::Mesh<3>>, const Restart*);
namespace
{

template <int dim>
void check(const case_file::Config& config, const mesh::Mesh<dim>& mesh, bool as_json)
{
  const problem::Problem<dim> given(case_file::resolve(config, mesh));
  const problem::Problem<dim> problem =
      config.history ? given.at(config.history->program.targets.front()) : given;
  (void)case_file::moment_point<dim>(config.output, mesh);  // throws for a wrong length
  (void)case_file::resolve_quantities<dim>(config, problem, mesh.boundary_names());
  (void)case_file::observations<dim>(config, mesh);
  const fem::LagrangeSpace<dim> space(mesh, config.method.degree);
  contact::NitscheForm<dim> form(problem, space, config.method.gamma_0());
  if (auto history = contact::history_at_first(form)) form.set_history(std::move(history));
  contact::check_interfaces(form);
  contact::check_rigid_motions(form);
  require_mesh_elsewhere(config);
  io::try_output_directory(config.output.directory);
  const io::CaseFacts facts = case_file::case_facts(config, dim);
  const io::MeshFacts about_mesh = io::mesh_facts<dim>(problem, space, form.constraints(), config.units);
  const std::string solver = io::describe_solver(solve::choose_method(form, config.method.solver, true));
  doctor::Diagnosis diagnosis = doctor::diagnose(form, config.method, config.adapt, config.units);
  if (config.history && !diagnosis.held_by_contact.empty())
    diagnosis.beyond_contact =
        doctor::load_beyond_contact<dim>(given, space, config.history->program.targets);
  const std::vector<doctor::Finding> findings = doctor::findings(diagnosis);
  print(as_json ? check_json(facts, about_mesh, solver, findings)
                : check_text(facts, about_mesh, solver) + findings_text(findings));
}

}  // namespace

void check(const CaseRequest& request, bool as_json)
{
  with_case(request, nullptr,
            [&]<int dim>(const case_file::Config& config, const mesh::Mesh<dim>& mesh)
            { check<dim>(config, mesh, as_json); });
}

}  // namespace tribound::app
