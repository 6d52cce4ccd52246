#include "app/command/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "app/output_directory.h"
#include "app/result/verification.h"
#include "tribound/adapt/regularisation.h"
#include "tribound/base/clock.h"
#include "tribound/case/resolve.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/support/rigid_motion.h"
#include "tribound/io/record/facts.h"
#include "tribound/solve/newton.h"

namespace tribound::app
{

namespace
{

/// The dual norm is looked for in degree p + 2, the reference solution in p + 1 (no solver goes beyond 4).
certify::RicherSpace dual_space(const case_file::Config& config, int refinements)
{
  return {.refinements = refinements, .degree = config.method.degree + 2};
}

certify::RicherSpace solution_space(const case_file::Config& config, int refinements)
{
  return {.refinements = refinements, .degree = std::min(config.method.degree + 1, 4)};
}

/// Above, the factorisations take more than about ten gigabytes (seen: 3.4 for a million in 2D with degree
/// 2).
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

/// Seconds of the stages of a verification.
class Stages
{
 public:
  explicit Stages(const Progress& progress) : progress_(progress) {}

  template <class Work>
  auto time(const std::string& stage, const std::string& announcement, const Work& work)
  {
    progress_.stage(announcement);
    const Clock::time_point begin = Clock::now();
    auto result = work();
    times_.emplace_back(stage, seconds_since(begin));
    return result;
  }

  [[nodiscard]] const std::vector<std::pair<std::string, double>>& times() const { return times_; }

 private:
  const Progress& progress_;
  std::vector<std::pair<std::string, double>> times_;
};

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
  iterate.norms = contact::stress_norms<dim>(form.problem(), form.space(), newton.u());
  iterate.identities =
      certify::check_identities<dim>(form, newton.traction, stress).largest(form.space().degree());
  return iterate;
}

template <int dim>
certify::RicherSolution richer_solution(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                        const case_file::Config& config, int refinements)
{
  const certify::RicherSpace richer = solution_space(config, refinements);
  const double gamma0 = config.method.gamma0.value_or(contact::default_gamma0(richer.degree));
  solve::NewtonOptions newton = config.method.newton;
  newton.damping = true;  // undamped steps may cycle; they are not what is verified here
  return certify::compare_with_richer<dim>(form, u, richer, gamma0, newton, config.method.solver);
}

}  // namespace

template <int dim>
ExitCode verify(const case_file::Config& config, const mesh::Mesh<dim>& mesh, int refinements,
                const Progress& progress)
{
  const problem::Problem<dim> problem(case_file::resolve(config, mesh));
  const fem::LagrangeSpace<dim> space(mesh, config.method.degree);
  const contact::NitscheForm<dim> form(problem, space, config.method.gamma_0());
  contact::check_rigid_motions(form);
  check_size(config, mesh, refinements);
  const OutputDirectory directory(config.output.directory);
  remove_results(config.output.directory, {"verify.json"});

  Verification result;
  result.facts = case_file::case_facts(config, dim);
  result.mesh = io::mesh_facts<dim>(problem, space, form.constraints());
  result.refinements = refinements;
  print_header(result.facts, result.mesh);

  Stages stages(progress);
  certify::DualNorm<dim> dual_norm(form, dual_space(config, refinements));
  result.dual_space = {dual_norm.space().degree(), dual_norm.space().mesh().n_cells(),
                       dual_norm.space().n_dofs()};
  const certify::Estimator<dim> estimator(form, config.method.contact_rule);
  std::optional<adapt::DeltaUpdates> regularisation;
  if (config.method.regularisation) regularisation = adapt::DeltaUpdates{*config.method.regularisation};
  const solve::NewtonObserver<dim> observer =
      [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    const certify::Stress<dim> stress =
        certify::equilibrate<dim>(form, iterate.u(), iterate.traction, 0, iterate.step.delta);
    const certify::Estimate eta = estimator(iterate.u(), stress);
    result.iterates.push_back(verified_iterate(form, iterate, stress, eta, dual_norm));
    progress(iterate.step);
    if (!regularisation) return false;
    return regularisation->advise(form, iterate, eta.global, iterate.converged);
  };
  algebra::SolverOptions solver = config.method.solver;
  solver.tolerance = 0;  // as far as rounding lets it be: the identities are not what is to fail
  const solve::NewtonResult<dim> newton =
      stages.time("iterates", "solving, with bound and dual norm of every iterate",
                  [&] { return solve::solve<dim>(form, {}, config.method.newton, solver, observer); });
  result.converged = newton.status == solve::NewtonStatus::converged;

  result.richer_degree = solution_space(config, refinements).degree;
  if (result.converged)
    result.richer =
        stages.time("richer", fmt::format("solving with degree {} on the refined mesh", result.richer_degree),
                    [&] { return richer_solution<dim>(form, newton.u, config, refinements); });
  result.times = stages.times();

  write_verification(config.output.directory, result);
  print_verification(result, (config.output.directory / "verify.json").string());
  if (const std::string problem_found = violation(result); !problem_found.empty())
    throw SolveError(problem_found);
  if (!result.converged) throw SolveError(newton.message);
  return ExitCode::success;
}

template ExitCode verify(const case_file::Config&, const mesh::Mesh<2>&, int, const Progress&);
template ExitCode verify(const case_file::Config&, const mesh::Mesh<3>&, int, const Progress&);

}  // namespace tribound::app
