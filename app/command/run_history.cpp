#include "app/command/run_history.h"

#include <functional>
#include <optional>
#include <utility>

#include "app/command/path_report.h"
#include "tribound/adapt/history_check.h"
#include "tribound/adapt/replay.h"
#include "tribound/adapt/transfer.h"
#include "tribound/base/rank_failure.h"
#include "tribound/io/state/path_checkpoint.h"

namespace tribound::app
{

namespace
{

/// The path that has been followed to its end, once more with half the steps on a finer mesh.
template <int dim>
void check_history(const case_file::Config& config, const problem::Problem<dim>& problem,
                   const std::atomic<bool>& stop, const Progress& progress, PathReport<dim>& report)
{
  const std::shared_ptr<const adapt::Grid<dim>> grid = report.last_grid();
  if (!grid) return;  // a run that had nothing left to do
  if (grid->mesh.ranks().any(stop)) return report.end_check({.failure = "interrupted"});
  const adapt::ReplayObserver<dim> observer{
      .newton = [&](const adapt::CertifiedStep& step) { progress(step.step, step.relative); },
      .begins = [&](int, const adapt::Grid<dim>& finer) { report.begin_check(finer); },
      .step = [&](const adapt::LoadStep<dim>& step) { report.add_to_check(step); }};
  report.end_check(
      adapt::follow_finely<dim>(*grid, problem, config.method, config.history->program, observer, &stop));
}

}  // namespace

template <int dim>
ExitCode run_history(const case_file::Config& config, const problem::Problem<dim>& problem,
                     mesh::Mesh<dim> mesh, std::vector<bool> slides, const std::atomic<bool>& stop,
                     const Progress& progress, std::shared_ptr<const mesh::Mesh<dim>> whole,
                     const std::optional<Restart>& restart, Clock::time_point begin)
{
  const adapt::PathOptions options{.tolerance = config.adapt.tolerance};
  auto path = std::make_unique<adapt::LoadPath<dim>>(problem, config.method, options, std::move(mesh), &stop,
                                                     std::move(whole));
  path->prepare(config.history->program.targets.front());
  const Ranks ranks = path->grid().mesh.ranks();
  PathReport<dim> report(config, problem, path->grid(), std::move(slides), begin,
                         progress.quiet() ? Printed::verdict : Printed::everything,
                         restart ? &*restart : nullptr);
  std::optional<adapt::ReplayState<dim>> from;
  if (restart)
    from = io::from_checkpoint<dim>(restart->facts, path->grid().space, restart->cells, restart->values,
                                    restart->points);
  const bool leaves_states = config.output.checkpoints != case_file::Checkpoints::none;
  const adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(config.adapt, &stop);
  const adapt::ReplayObserver<dim> observer{
      .newton = [&](const adapt::CertifiedStep& step) { progress(step.step, step.relative); },
      .begins = [&](int pass, const adapt::Grid<dim>& grid) { report.begin(pass, grid); },
      .step = [&](const adapt::LoadStep<dim>& step) { report.add(step); },
      .state = leaves_states ? [&](const adapt::ReplayState<dim>& state) { report.write_checkpoint(state); }
                             : std::function<void(const adapt::ReplayState<dim>&)>(),
      .path_end = [&](const adapt::PathEnd& end) { report.note(end); },
      .complete = [&](const adapt::PassView<dim>& pass) { report.complete(pass); },
      .given_up = [&] { return report.give_up(); },
      .finer = [&](const adapt::PassView<dim>& left, const adapt::Grid<dim>& grid)
      { report.refine(left, grid); }};
  const adapt::PathProgram& program = config.history->program;
  try
  {
    const adapt::ReplayState<dim>* state = from ? &*from : nullptr;
    const certify::Verdict verdict =
        config.history->refine == case_file::Refine::transfer
            ? adapt::transfer<dim>(*path, program, strategy, observer, state)
            : adapt::replay<dim>(std::move(path), program, strategy, observer, state);
    path.reset();  // its factors are in the way
    if (config.history->check && certify::is_bound(verdict.status))
      check_history<dim>(config, problem, stop, progress, report);
    return report.close(verdict);
  }
  catch (const SolveError& error)
  {
    require_all_failed(ranks, error.what());
    report.fail(error.what());
    throw;
  }
  catch (const InputError& error)  // data that are not valid at a later t: the steps before hold
  {
    require_all_failed(ranks, error.what());
    report.fail(error.what());
    throw;
  }
}

template ExitCode run_history(const case_file::Config&, const problem::Problem<2>&, mesh::Mesh<2>,
                              std::vector<bool>, const std::atomic<bool>&, const Progress&,
                              std::shared_ptr<const mesh::Mesh<2>>, const std::optional<Restart>&,
                              Clock::time_point);
template ExitCode run_history(const case_file::Config&, const problem::Problem<3>&, mesh::Mesh<3>,
                              std::vector<bool>, const std::atomic<bool>&, const Progress&,
                              std::shared_ptr<const mesh::Mesh<3>>, const std::optional<Restart>&,
                              Clock::time_point);

}  // namespace tribound::app
