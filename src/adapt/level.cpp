#include "adapt/level.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/clock.h"
#include "certify/equilibrate.h"
#include "contact/elasticity.h"

namespace tribound
{

bool linearisation_is_negligible(const BoundComponents& eta, double gamma_lin)
{
  return eta.linearisation() <= gamma_lin * (eta.discretisation() + eta.regularisation());
}

bool linearisation_is_negligible(const Estimate& estimate, const NewtonConfig& config)
{
  const auto negligible = [&](const BoundComponents& eta)
  { return linearisation_is_negligible(eta, config.gamma_lin); };
  switch (config.stopping)
  {
    case Stopping::adaptive:
      return negligible(estimate.global);
    case Stopping::adaptive_local:
      return std::ranges::all_of(estimate.cells, negligible);
    default:
      return false;
  }
}

namespace
{

/// lin1, lin2n and lin2t alone.
BoundComponents linearisation_part(const BoundComponents& eta)
{
  BoundComponents part;
  for (const auto member : linearisation_components) part.*member = eta.*member;
  return part;
}

/// Bounds the iterates on one mesh.
template <int dim>
class Certifier
{
 public:
  Certifier(const NitscheForm<dim>& form, const Config& config, const std::optional<double>& expected,
            const std::optional<FriedrichsConstant>& friedrichs)
      : form_(form),
        config_(config),
        known_(expected),
        equilibrator_(form),
        estimator_(form, config.certify.contact_rule, friedrichs)
  {
  }

  /// Whether the iterate may be kept as the solution; its bound, unless sigma_lin alone says that it may not.
  [[nodiscard]] bool examine(std::span<const double> u, std::span<const Point<dim>> t, CertifiedStep& step,
                             CertifiedLevel<dim>& level)
  {
    if (always_complete() || !known_ || may_be_accepted(u, t, step)) complete(u, t, step, level);
    return step.bound && linearisation_is_negligible(level.estimate, config_.newton);
  }

  /// The stress of the iterate and its bound.
  void complete(std::span<const double> u, std::span<const Point<dim>> t, CertifiedStep& step,
                CertifiedLevel<dim>& level)
  {
    level.stress = equilibrator_(u, t, step.step.delta);
    level.estimate = estimator_(u, level.stress);
    level.friedrichs = estimator_.friedrichs();
    level.norms = stress_norms(form_.problem(), form_.space(), u);
    step.bound = level.estimate;
    step.linearisation = linearisation_part(level.estimate.global);
    if (level.norms.sigma > 0) step.relative = level.estimate.total_sharp / level.norms.sigma;
    known_ = level.estimate.global.discretisation();
  }

 private:
  [[nodiscard]] bool always_complete() const
  {
    return dim == 2 || config_.newton.stopping == Stopping::tolerance || config_.regularisation;
  }

  /// Whether the linearisation error may be negligible, the discretisation error being that last known. What
  /// is negligible on every cell is so in all but for a factor: |x| + |y| + |z| <= 3^{1/2} |x + y + z| for
  /// vectors x, y, z >= 0.
  bool may_be_accepted(std::span<const double> u, std::span<const Point<dim>> t, CertifiedStep& step)
  {
    const double factor = config_.newton.stopping == Stopping::adaptive_local ? std::numbers::sqrt3 : 1;
    step.linearisation = estimator_.linearisation(equilibrator_.linearisation(u, t));
    return step.linearisation->linearisation() <= factor * config_.newton.gamma_lin * *known_;
  }

  const NitscheForm<dim>& form_;
  const Config& config_;
  std::optional<double> known_;  ///< discretisation() of the last complete bound, or as expected
  Equilibrator<dim> equilibrator_;
  Estimator<dim> estimator_;
};

}  // namespace

template <int dim>
CertifiedLevel<dim> solve_and_certify(const NitscheForm<dim>& form, std::span<const double> start,
                                      const Config& config, const StepObserver& observer, double delta,
                                      const std::optional<double>& expected,
                                      const std::optional<FriedrichsConstant>& friedrichs)
{
  CertifiedLevel<dim> level;
  double wall = 0;
  double cpu = 0;
  std::optional<Certifier<dim>> certifier;
  std::optional<DeltaUpdates> regularisation;
  if (config.regularisation) regularisation = DeltaUpdates{*config.regularisation, delta};

  const auto certify = [&](const NewtonIterate<dim>& iterate)
  {
    CertifiedStep& step = level.steps.emplace_back(CertifiedStep{iterate.step, {}});
    NewtonAdvice advice = false;
    if (std::isfinite(iterate.step.residual))
    {
      const Charge charge(level.certify_seconds, level.certify_cpu);
      if (!certifier) certifier.emplace(form, config, expected, friedrichs);
      advice = certifier->examine(iterate.u, iterate.traction, step, level);
      if (regularisation)
        advice = regularisation->advise(form, iterate, level.estimate.global,
                                        advice.good_enough || iterate.converged);
      step.accepted = advice.good_enough;
    }
    if (observer) observer(step);
    return advice;
  };
  NewtonResult<dim> newton;
  {
    const Charge charge(wall, cpu);
    newton = solve<dim>(form, start, config.newton, config.solver, certify, delta);
  }
  level.solve_seconds = wall - level.certify_seconds;
  level.solve_cpu = cpu - level.certify_cpu;
  if (regularisation)
  {
    level.delta = regularisation->delta;
    level.delta_updates = regularisation->n_updates;
  }
  level.failure = std::move(newton.message);
  level.u = std::move(newton.u);
  if (level.solved())
  {
    const Charge charge(level.certify_seconds, level.certify_cpu);
    CertifiedStep& last = level.steps.back();
    if (!last.bound) certifier->complete(level.u, newton.traction, last, level);
    last.accepted = true;
    level.identities = check_identities<dim>(form, newton.traction, level.stress);
  }
  else
    level.norms = stress_norms(form.problem(), form.space(), level.u);
  return level;
}

template CertifiedLevel<2> solve_and_certify(const NitscheForm<2>&, std::span<const double>, const Config&,
                                             const StepObserver&, double, const std::optional<double>&,
                                             const std::optional<FriedrichsConstant>&);
template CertifiedLevel<3> solve_and_certify(const NitscheForm<3>&, std::span<const double>, const Config&,
                                             const StepObserver&, double, const std::optional<double>&,
                                             const std::optional<FriedrichsConstant>&);

}  // namespace tribound
