#include "adapt/level.h"

#include <cmath>
#include <utility>

#include "base/clock.h"
#include "certify/equilibrate.h"
#include "contact/elasticity.h"

namespace tribound
{

bool linearisation_is_negligible(const BoundComponents& eta, double gamma_lin)
{
  return eta.lin1 + eta.lin2n + eta.lin2t <= gamma_lin * (eta.osc + eta.str + eta.neu + eta.cnt + eta.frc);
}

template <int dim>
CertifiedLevel<dim> solve_and_certify(const NitscheForm<dim>& form, std::span<const double> start,
                                      const Config& config, const StepObserver& observer)
{
  const Clock::time_point begin = Clock::now();
  CertifiedLevel<dim> level;
  const Estimator<dim> estimator(form, config.certify.contact_rule);
  level.certify_seconds = seconds_since(begin);

  // Every step rebuilds the stress of its own iterate, so that the bound holds for whichever is kept.
  const auto certify = [&](const NewtonIterate<dim>& iterate)
  {
    const Clock::time_point before = Clock::now();
    CertifiedStep& step = level.steps.emplace_back(CertifiedStep{iterate.step, {}});
    if (std::isfinite(iterate.step.residual))
    {
      level.stress = equilibrate<dim>(form, iterate.u, iterate.traction);
      level.estimate = estimator(iterate.u, level.stress);
      step.bound = level.estimate;
      level.sigma_norm = stress_norms(form.problem(), form.space(), iterate.u).sigma;
      if (level.sigma_norm > 0) step.relative = level.estimate.total_sharp / level.sigma_norm;
      step.accepted = config.newton.stopping == Stopping::adaptive &&
                      linearisation_is_negligible(level.estimate.global, config.newton.gamma_lin);
    }
    level.certify_seconds += seconds_since(before);
    if (observer) observer(step);
    return step.accepted;
  };
  NewtonResult<dim> newton = solve<dim>(form, start, config.newton, config.solver, certify);
  level.failure = std::move(newton.message);
  level.u = std::move(newton.u);
  if (level.solved())
  {
    level.steps.back().accepted = true;
    const Clock::time_point before = Clock::now();
    level.identities = check_identities<dim>(form, newton.traction, level.stress);
    level.certify_seconds += seconds_since(before);
  }
  level.solve_seconds = seconds_since(begin) - level.certify_seconds;
  return level;
}

template CertifiedLevel<2> solve_and_certify(const NitscheForm<2>&, std::span<const double>, const Config&,
                                             const StepObserver&);
template CertifiedLevel<3> solve_and_certify(const NitscheForm<3>&, std::span<const double>, const Config&,
                                             const StepObserver&);

}  // namespace tribound
