#include "app/command/run.h"

#include <atomic>
#include <memory>
#include <utility>

#include "app/command/interrupt.h"
#include "app/command/run_report.h"
#include "app/console/balance_text.h"
#include "app/console/forecast.h"
#include "app/output_directory.h"
#include "tribound/adapt/loop.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/base/clock.h"
#include "tribound/contact/support/rigid_motion.h"
#include "tribound/doctor/diagnosis.h"
#include "tribound/doctor/findings.h"

namespace tribound
{

template <int dim>
ExitCode run(const Config& config, Mesh<dim> mesh, const Progress& progress)
{
  const Clock::time_point begin = Clock::now();
  const Problem<dim> problem(config, mesh.region_names(), mesh.boundary_names());
  auto first = std::make_unique<Discretisation<dim>>(std::move(mesh), problem, config);
  const std::atomic<bool>& stop = stop_on_signals();
  if (stop) throw SolveError("interrupted before anything was solved; nothing is written");
  RunReport<dim> report(config, problem, *first, begin,
                        progress.quiet() ? Printed::verdict : Printed::everything);
  const LoopObserver<dim> observer = {[&](const CertifiedStep& step) { progress(step.step, step.relative); },
                                      [&](const LevelView<dim>& view)
                                      {
                                        report.add(view);
                                        const std::string forecast =
                                            forecast_text(report.record(), config.adapt.max_dofs);
                                        if (!forecast.empty()) progress.stage(forecast);
                                      }};
  try
  {
    return report.close(adapt<dim>(problem, config, std::move(first), observer, stop));
  }
  catch (const SolveError& error)
  {
    report.fail(error.what());
    throw;
  }
}

template <int dim>
void check(const Config& config, const Mesh<dim>& mesh, bool as_json)
{
  const Problem<dim> problem(config, mesh.region_names(), mesh.boundary_names());
  (void)moment_point<dim>(config.output, mesh);  // throws where it has the wrong length
  const LagrangeSpace<dim> space(mesh, config.degree);
  const NitscheForm<dim> form(problem, space, config.gamma0());
  check_rigid_motions<dim>(problem, space, form.data(), form.load());
  require_mesh_elsewhere(config);
  try_output_directory(config.output.directory);
  print_check(case_facts(config, dim), mesh_facts<dim>(problem, space, form.constraints()),
              describe_solver(choose_method(config.solver, dim, space.n_dofs())),
              findings(diagnose(config, form)), as_json);
}

template ExitCode run(const Config&, Mesh<2>, const Progress&);
template ExitCode run(const Config&, Mesh<3>, const Progress&);
template void check(const Config&, const Mesh<2>&, bool);
template void check(const Config&, const Mesh<3>&, bool);

}  // namespace tribound
