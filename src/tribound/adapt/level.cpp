#include "tribound/adapt/level.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/adapt/certifier.h"
#include "tribound/adapt/contact_hold.h"
#include "tribound/adapt/persistent.h"
#include "tribound/base/clock.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::adapt
{

bool linearisation_is_negligible(const certify::BoundComponents& eta, double gamma_lin)
{
  return eta.linearisation() <= negligible_linearisation(eta, gamma_lin);
}

bool linearisation_is_negligible(const certify::Estimate& estimate, const StoppingOptions& stopping,
                                 const Ranks& ranks)
{
  const auto negligible = [&](const certify::BoundComponents& eta)
  { return linearisation_is_negligible(eta, stopping.gamma_lin); };
  switch (stopping.criterion)
  {
    case Stopping::adaptive:
      return negligible(estimate.global);
    case Stopping::adaptive_local:
      return !ranks.any(!std::ranges::all_of(estimate.cells, negligible));
    default:
      return false;
  }
}

namespace
{

bool is_iterative(const solve::NewtonStep& step)
{
  return step.method == algebra::LinearMethod::iterative;
}

/// The number of steps after the one at which Stopping::adaptive would have ended, by the last bound.
int steps_beyond_need(std::span<const CertifiedStep> steps, const certify::BoundComponents& eta,
                      double gamma_lin)
{
  const double negligible = negligible_linearisation(eta, gamma_lin);
  const auto needed = std::ranges::find_if(
      steps, [&](const CertifiedStep& step)
      { return step.linearisation && step.linearisation->linearisation() <= negligible; });
  return std::max(0, static_cast<int>(steps.end() - needed) - 1);
}

/// The stress, the bound and the identities of the last step, whose iterate is kept.
template <int dim>
void keep_last(Certifier<dim>& certifier, CertifiedLevel<dim>& level)
{
  CertifiedStep& last = level.steps.back();
  if (!last.bound) certifier.complete(level.u, level.traction, last, level);
  last.accepted = true;
  level.identities = certifier.identities(level);
}

void append_step(const solve::NewtonStep& step, std::vector<CertifiedStep>& steps)
{
  steps.push_back({step, {}});
  steps.back().step.step = static_cast<int>(steps.size());
}

template <int dim>
void keep_solution(const contact::NitscheForm<dim>& form, solve::NewtonResult<dim>&& newton,
                   CertifiedLevel<dim>& level)
{
  level.failure = std::move(newton.message);
  if (!level.solved()) level.failure += words_of_hold(form);
  level.converged = newton.status == solve::NewtonStatus::converged;
  level.u = std::move(newton.u);
  level.traction = std::move(newton.traction);
  level.equilibrium = std::move(newton.equilibrium);
}

/// Solves the systems of the level as accurately as rounding allows, where this repairs the bound.
template <int dim>
void tighten(const contact::NitscheForm<dim>& form, const Method& method, const StepObserver& observer,
             CertifiedLevel<dim>& level)
{
  Method tight = method;
  tight.solver.tolerance = 0;
  if (level.equilibrium->method() == algebra::LinearMethod::condensed)
    tight.solver.method = algebra::LinearMethod::direct;
  level.equilibrium.reset();
  try
  {
    if (std::optional<CertifiedLevel<dim>> better = converge<dim>(form, level, tight, observer))
      level = std::move(*better);
  }
  catch (const SolveError& error)  // the identities stay as they are, and the bound is rejected
  {
    require_all_failed(form.space().mesh().ranks(), error.what());
  }
  level.finishing_steps = 0;
  level.tightened = true;
}

}  // namespace

template <int dim>
bool bound_holds(const CertifiedLevel<dim>& level)
{
  if (!level.solved()) return false;
  const certify::Verdict verdict = certify::judge(level.estimate, level.identities, level.norms, 0);
  return verdict.status != certify::RunStatus::not_certified;
}

template <int dim>
std::optional<CertifiedLevel<dim>> converge(const contact::NitscheForm<dim>& form,
                                            const CertifiedLevel<dim>& level, const Method& method,
                                            const StepObserver& observer)
{
  CertifiedLevel<dim> result = level;
  const int before = static_cast<int>(level.steps.size());
  const solve::NewtonObserver<dim> record = [&](const solve::NewtonIterate<dim>& iterate)
  {
    CertifiedStep& step = result.steps.emplace_back(CertifiedStep{iterate.step, {}});
    step.step.step += before;
    if (observer) observer(step);
    return false;
  };
  solve::NewtonResult<dim> newton;
  {
    const ScopedTimer timer(result.solve_seconds, result.solve_cpu);
    newton = solve::solve<dim>(form, level.u, method.newton, method.solver, record, level.delta,
                               level.equilibrium);
  }
  if (newton.status != solve::NewtonStatus::converged) return std::nullopt;
  for (CertifiedStep& step : result.steps) step.accepted = false;
  result.finishing_steps += static_cast<int>(result.steps.size()) - before;
  result.energy.reset();
  keep_solution(form, std::move(newton), result);
  {
    const ScopedTimer timer(result.certify_seconds, result.certify_cpu);
    Certifier<dim> certifier(form, method, {}, level.friedrichs);
    keep_last(certifier, result);
  }
  if (!bound_holds(result)) return std::nullopt;
  return result;
}

template <int dim>
void certify_again(const contact::NitscheForm<dim>& form, const Method& method, CertifiedLevel<dim>& level)
{
  const ScopedTimer timer(level.certify_seconds, level.certify_cpu);
  Certifier<dim> certifier(form, method, {}, level.friedrichs);
  certifier.complete(level.u, level.traction, level.steps.back(), level);
}

template <int dim>
CertifiedLevel<dim> solve_and_certify(const contact::NitscheForm<dim>& form, std::span<const double> start,
                                      const Method& method, const StepObserver& observer, double delta,
                                      const std::optional<double>& expected,
                                      const std::optional<certify::FriedrichsConstant>& friedrichs,
                                      std::shared_ptr<solve::Equilibrium<dim>> equilibrium)
{
  CertifiedLevel<dim> level;
  double wall = 0;
  double cpu = 0;
  std::optional<Certifier<dim>> certifier;
  std::optional<DeltaUpdates> regularisation;
  if (method.regularisation) regularisation = DeltaUpdates{*method.regularisation, delta};

  const auto record = [&](const solve::NewtonStep& step) { append_step(step, level.steps); };
  const auto certify = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    CertifiedStep& step = level.steps.back();
    solve::NewtonAdvice advice = false;
    if (std::isfinite(iterate.step.residual))
    {
      const auto timed = [&](auto work)
      {
        const ScopedTimer timer(level.certify_seconds, level.certify_cpu);
        return work();
      };
      if (!certifier) timed([&] { certifier.emplace(form, method, expected, friedrichs); });
      if (timed([&] { return certifier->is_candidate(iterate, step); }))
      {
        const auto complete = [&]
        {
          const std::span<const double> u = iterate.u();
          timed([&] { certifier->complete(u, iterate.traction, step, level); });
        };
        complete();
        if (is_iterative(iterate.step) && !certifier->is_balanced(level)) complete();
        step.step.linear_iterations = iterate.step.linear_iterations;
        advice = certifier->accepts(level);
      }
      if (regularisation)
        advice = regularisation->advise(form, iterate, level.estimate.global,
                                        advice.good_enough || iterate.converged);
      step.accepted = advice.good_enough;
    }
    if (observer) observer(step);
    return advice;
  };
  Method balanced = method;
  if (method.solver.gamma_alg > 0)
    balanced.newton.small_enough = [&](std::span<const double> residual)
    { return certifier && certifier->is_balanced(residual); };
  solve::NewtonResult<dim> newton;
  {
    const ScopedTimer timer(wall, cpu);
    newton = solve_persistently<dim>(
        form, start, balanced, certify, delta,
        [&](const solve::NewtonStep& step)
        {
          record(step);
          if (observer) observer(level.steps.back());
        },
        std::move(equilibrium));
  }
  level.solve_seconds = wall - level.certify_seconds;
  level.solve_cpu = cpu - level.certify_cpu;
  if (regularisation)
  {
    level.delta = regularisation->delta;
    level.delta_updates = regularisation->n_updates;
  }
  keep_solution(form, std::move(newton), level);
  if (!level.solved())
  {
    level.norms = contact::stress_norms<dim>(form, level.u);
    return level;
  }
  {
    const ScopedTimer timer(level.certify_seconds, level.certify_cpu);
    keep_last(*certifier, level);
  }
  if (method.stopping.criterion == Stopping::last_bounded)
    level.finishing_steps = steps_beyond_need(level.steps, level.estimate.global, method.stopping.gamma_lin);
  const bool is_loose = !certifier->is_balanced(level) && !certify::is_round_off(level.estimate, level.norms);
  if (is_loose || !bound_holds(level)) tighten(form, method, observer, level);
  return level;
}

template <int dim>
CertifiedLevel<dim> solve_without_bound(const contact::NitscheForm<dim>& form, std::span<const double> start,
                                        const Method& method, const StepObserver& observer,
                                        std::shared_ptr<solve::Equilibrium<dim>> equilibrium)
{
  CertifiedLevel<dim> level;
  const auto record = [&](const solve::NewtonStep& step)
  {
    append_step(step, level.steps);
    if (observer) observer(level.steps.back());
  };
  const auto go_on = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    return false;
  };
  {
    const ScopedTimer timer(level.solve_seconds, level.solve_cpu);
    keep_solution(
        form, solve_persistently<dim>(form, start, method, go_on, 0, record, std::move(equilibrium)), level);
  }
  level.norms = contact::stress_norms<dim>(form, level.u);
  return level;
}

template CertifiedLevel<2> solve_and_certify(const contact::NitscheForm<2>&, std::span<const double>,
                                             const Method&, const StepObserver&, double,
                                             const std::optional<double>&,
                                             const std::optional<certify::FriedrichsConstant>&,
                                             std::shared_ptr<solve::Equilibrium<2>>);
template CertifiedLevel<3> solve_and_certify(const contact::NitscheForm<3>&, std::span<const double>,
                                             const Method&, const StepObserver&, double,
                                             const std::optional<double>&,
                                             const std::optional<certify::FriedrichsConstant>&,
                                             std::shared_ptr<solve::Equilibrium<3>>);
template CertifiedLevel<2> solve_without_bound(const contact::NitscheForm<2>&, std::span<const double>,
                                               const Method&, const StepObserver&,
                                               std::shared_ptr<solve::Equilibrium<2>>);
template CertifiedLevel<3> solve_without_bound(const contact::NitscheForm<3>&, std::span<const double>,
                                               const Method&, const StepObserver&,
                                               std::shared_ptr<solve::Equilibrium<3>>);
template std::optional<CertifiedLevel<2>> converge(const contact::NitscheForm<2>&, const CertifiedLevel<2>&,
                                                   const Method&, const StepObserver&);
template std::optional<CertifiedLevel<3>> converge(const contact::NitscheForm<3>&, const CertifiedLevel<3>&,
                                                   const Method&, const StepObserver&);
template void certify_again(const contact::NitscheForm<2>&, const Method&, CertifiedLevel<2>&);
template void certify_again(const contact::NitscheForm<3>&, const Method&, CertifiedLevel<3>&);
template bool bound_holds(const CertifiedLevel<2>&);
template bool bound_holds(const CertifiedLevel<3>&);

}  // namespace tribound::adapt
