#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "app/command/with_case.h"
#include "app/console/console.h"
#include "app/console/text.h"
#include "app/result/verification.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/adapt/path_program.h"
#include "tribound/adapt/regularisation.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/clock.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/resolve.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/support/rigid_motion.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/output_directory.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/facts.h"
#include "tribound/solve/newton.h"

namespace tribound::app
{

namespace
{

/// The dual norm is computed in degree p + 2, the reference solution in p + 1 (no solver goes beyond 4).
certify::RicherSpace dual_space(const case_file::Config& config, int refinements)
{
  return {.refinements = refinements, .degree = config.method.degree + 2};
}

certify::RicherSpace solution_space(const case_file::Config& config, int refinements)
{
  return {.refinements = refinements, .degree = std::min(config.method.degree + 1, 4)};
}

/// Beyond this, the factorisations need more than about ten gigabytes (observed: 3.4 for a million in 2D with
/// degree 2).
template <int dim>
constexpr double largest_problem = dim == 2 ? 3e6 : 1e6;

template <int dim>
void check_size(const case_file::Config& config, const mesh::Mesh<dim>& mesh, int refinements)
{
  const auto n_dofs = [&](int times) { return certify::count_dofs(mesh, dual_space(config, times)); };
  if (n_dofs(refinements) <= largest_problem<dim>) return;
  int fewer = refinements - 1;
  while (fewer > 0 && n_dofs(fewer) > largest_problem<dim>) --fewer;
  throw InputError(mesh.source(),
                   fmt::format("verifying degree {} on this mesh refined {} {} takes about {:.2g} degrees of "
                               "freedom; the limit is {:.2g}",
                               config.method.degree, refinements, refinements == 1 ? "time" : "times",
                               n_dofs(refinements), largest_problem<dim>),
                   fewer == 0 ? "take a coarser mesh or a lower degree"
                              : fmt::format("take a coarser mesh, a lower degree or --refinements {} (about "
                                            "{:.2g} degrees of freedom)",
                                            fewer, n_dofs(fewer)));
}

/// Calls work() and records its wall time as that of a stage.
template <class Work>
auto timed(const std::string& stage, Verification& result, const Work& work)
{
  const Clock::time_point begin = Clock::now();
  auto value = work();
  result.times.emplace_back(stage, seconds_since(begin));
  return value;
}

template <int dim>
VerifiedIterate verified_iterate(const contact::NitscheForm<dim>& form,
                                 const solve::NewtonIterate<dim>& newton, const certify::Stress<dim>& stress,
                                 const certify::Bound& eta, certify::DualNorm<dim>& dual_norm)
{
  VerifiedIterate iterate;
  iterate.step = newton.step;
  iterate.bound = eta.total_sharp;
  iterate.bound_plain = eta.total;
  iterate.dual_norm = dual_norm(newton.u());
  iterate.norms = contact::stress_norms<dim>(form, newton.u());
  iterate.identities = certify::check_identities<dim>(form, newton.traction, stress).largest();
  return iterate;
}

/// Runs Newton's method on a form from `start`; verifies each iterate and adds it to `result`, with the
/// intervals of the quantities, if there are any.
template <int dim>
solve::NewtonResult<dim> verify_iterates(const contact::NitscheForm<dim>& form, std::span<const double> start,
                                         const solve::NewtonOptions& options, const case_file::Config& config,
                                         Verification& result, const Progress& progress,
                                         const std::vector<problem::Quantity<dim>>& quantities = {})
{
  certify::DualNorm<dim> dual_norm(form, dual_space(config, result.refinements));
  result.dual_space = {dual_norm.space().degree(), dual_norm.space().mesh().n_cells(),
                       dual_norm.space().n_dofs()};
  const certify::Estimator<dim> estimator(form, config.method.contact_rule);
  std::optional<adapt::DeltaUpdates> regularisation;
  if (config.method.regularisation) regularisation = adapt::DeltaUpdates{*config.method.regularisation};
  const solve::NewtonObserver<dim> observer =
      [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    const certify::Stress<dim> stress = certify::equilibrate<dim>(form, iterate.u(), iterate.traction, 0,
                                                                  iterate.step.delta, config.method.stress);
    const certify::Estimate eta = estimator(iterate.u(), stress);
    result.iterates.push_back(verified_iterate(form, iterate, stress, eta, dual_norm));
    if (!quantities.empty())
      result.iterates.back().energy = adapt::energy_bound<dim>(form, config.method, iterate.u(), quantities);
    progress({.step = iterate.step});
    if (!regularisation) return false;
    return regularisation->advise(form, iterate, eta.global, iterate.converged);
  };
  algebra::SolverOptions solver = config.method.solver;
  solver.tolerance = 0;  // as accurate as rounding allows, so that identities do not fail for it
  return solve::solve<dim>(form, start, options, solver, observer);
}

/// Repeats the iterates of a committed load step from their start: its form still has the history left by the
/// previous step.
template <int dim>
void verify_step(const adapt::LoadStep<dim>& step, std::span<const double> start,
                 const case_file::Config& config, Verification& result, const Progress& progress)
{
  solve::NewtonOptions options = config.method.newton;
  options.reference_force = step.reference_force;
  const std::size_t first = result.iterates.size();
  const bool converged =
      verify_iterates<dim>(step.at->discrete.form, start, options, config, result, progress).status ==
      solve::NewtonStatus::converged;
  result.converged = result.converged && converged;
  for (std::size_t i = first; i < result.iterates.size(); ++i)
  {
    VerifiedIterate& iterate = result.iterates[i];
    iterate.load_step = step.number;
    iterate.t = step.t;
    iterate.path_sigma = step.largest_sigma;
    iterate.identities *= std::min(1.0, (iterate.norms.sigma + iterate.bound) / step.largest_sigma);
  }
}

constexpr const char* announcement = "solving, with bound and dual norm of every iterate";

/// Called once the input is known to be valid: takes the directory and prints what will be verified.
template <int dim>
std::unique_ptr<io::OutputDirectory> begin(const case_file::Config& config,
                                           const problem::Problem<dim>& problem,
                                           const fem::LagrangeSpace<dim>& space,
                                           const fem::Constraints& constraints, Verification& result)
{
  auto directory = std::make_unique<io::OutputDirectory>(config.output.directory);
  io::remove_results(config.output.directory, {"verify.json"});
  result.mesh = io::mesh_facts<dim>(problem, space, constraints, config.units);
  print(header_text(result.facts, result.mesh));
  return directory;
}

/// Returns why the load steps end before the last one; empty: they do not.
template <int dim>
std::string verify_path(const problem::Problem<dim>& problem, mesh::Mesh<dim> mesh,
                        const case_file::Config& config, Verification& result, const Progress& progress,
                        std::unique_ptr<io::OutputDirectory>& directory)
{
  adapt::LoadPath<dim> path(problem, config.method, {}, std::move(mesh));
  path.prepare(config.history->program.targets.front());
  const fem::LagrangeSpace<dim>& space = path.grid().space;
  directory = begin<dim>(config, problem, space, fem::dirichlet<dim>(problem, space), result);
  std::vector<double> before;
  result.converged = true;
  const auto committed = [&](const adapt::LoadStep<dim>& step)
  {
    verify_step<dim>(step, step.start.empty() ? before : step.start, config, result, progress);
    before = step.level.u;
  };
  progress.stage(announcement);
  std::string why =
      timed("iterates", result,
            [&] { return adapt::follow<dim>(path, config.history->program, committed, {}).failure; });
  if (why.empty() && !result.converged) why = "Newton's method did not converge a second time";
  return why;
}

/// The richer solution, and the bound of the solution's error in the energy norm.
template <int dim>
void verify_solution(const contact::NitscheForm<dim>& form, std::span<const double> u,
                     const case_file::Config& config, const std::vector<problem::Quantity<dim>>& quantities,
                     Verification& result, const Progress& progress)
{
  const certify::RicherSpace space = solution_space(config, result.refinements);
  const double gamma0 = config.method.gamma0.value_or(contact::default_gamma0(space.degree));
  solve::NewtonOptions newton = config.method.newton;
  newton.damping = true;  // undamped steps may cycle, and are not being verified here
  const auto bound_richer = [&](const contact::NitscheForm<dim>& richer, std::span<const double> richer_u)
  {
    if (!quantities.empty())
      result.richer_energy = adapt::energy_bound<dim>(richer, config.method, richer_u, quantities);
  };
  progress.stage(fmt::format("solving with degree {} on the refined mesh", space.degree));
  result.richer = timed("richer", result,
                        [&]
                        {
                          return certify::compare_with_richer<dim>(form, u, space, gamma0, newton,
                                                                   config.method.solver, bound_richer);
                        });
  const double circle = form.problem().full_circle();
  if (result.richer && result.richer->error) result.richer->error->energy *= std::sqrt(circle);
  result.energy = result.iterates.back().energy;
  if (!result.energy && config.adapt.bars.levels != adapt::EnergyLevels::off)
  {
    progress.stage("bounding the error in the energy norm");
    result.energy = timed("energy", result, [&] { return adapt::energy_bound<dim>(form, config.method, u); });
  }
  if (result.energy) io::scale_energies(*result.energy, circle);
}

/// Returns why there is no solution; empty: there is one.
template <int dim>
std::string verify_single(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                          const case_file::Config& config, Verification& result, const Progress& progress,
                          std::unique_ptr<io::OutputDirectory>& directory)
{
  const fem::LagrangeSpace<dim> space(mesh, config.method.degree);
  const contact::NitscheForm<dim> form(problem, space, config.method.gamma_0());
  const auto quantities = case_file::resolve_quantities<dim>(config, problem, mesh.boundary_names());
  contact::check_rigid_motions(form);
  directory = begin<dim>(config, problem, space, form.constraints(), result);
  progress.stage(announcement);
  const solve::NewtonResult<dim> newton = timed(
      "iterates", result,
      [&]
      { return verify_iterates<dim>(form, {}, config.method.newton, config, result, progress, quantities); });
  result.converged = newton.status == solve::NewtonStatus::converged;
  result.richer_degree = solution_space(config, result.refinements).degree;
  if (result.converged) verify_solution<dim>(form, newton.u, config, quantities, result, progress);
  return result.converged ? std::string() : newton.message;
}

template <int dim>
ExitCode verify(const case_file::Config& config, mesh::Mesh<dim> mesh, int refinements,
                const Progress& progress)
{
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  check_size(config, mesh, refinements);
  std::unique_ptr<io::OutputDirectory> directory;
  Verification result;
  result.facts = case_file::case_facts(config, dim);
  result.refinements = refinements;
  std::string failure = config.history
                            ? verify_path<dim>(problem, std::move(mesh), config, result, progress, directory)
                            : verify_single<dim>(problem, mesh, config, result, progress, directory);
  if (result.iterates.empty()) throw SolveError(failure);

  const std::filesystem::path file = config.output.directory / "verify.json";
  io::write_file(file, verification_json(result));
  print(verification_text(result, file.string()));
  if (const std::string problem_found = violation(result); !problem_found.empty())
    throw SolveError(problem_found);
  if (!result.converged || !failure.empty()) throw SolveError(failure);
  return ExitCode::success;
}

}  // namespace

ExitCode verify(const CaseRequest& request, int refinements)
{
  return with_case(request, nullptr,
                   [&]<int dim>(const case_file::Config& config, mesh::Mesh<dim> mesh)
                   {
                     const algebra::Environment environment;
                     return verify<dim>(config, std::move(mesh), refinements, Progress(request.quiet));
                   });
}

}  // namespace tribound::app
