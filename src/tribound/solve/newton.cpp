#include "tribound/solve/newton.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tribound/base/clock.h"
#include "tribound/solve/newton_iteration.h"

namespace tribound::solve
{

namespace
{

template <int dim>
NewtonResult<dim> run(NewtonIteration<dim>& iteration, const NewtonOptions& options, bool is_new,
                      const NewtonObserver<dim>& observer)
{
  NewtonResult<dim> result;
  const bool at_rest = is_new && iteration.at_rest();
  int without_progress = 0;
  for (int k = 1; k <= options.max_steps && result.status == NewtonStatus::too_many_steps; ++k)
  {
    const Clock::time_point begin = Clock::now();
    const bool from_scratch = k == 1 && is_new;
    const double before = iteration.residual_norm();
    iteration.begin(k);
    if (!at_rest)
      iteration.step(from_scratch ? contact::Linearisation::closed_sticking : contact::Linearisation::newton);
    iteration.report().seconds = seconds_since(begin);
    without_progress = k > 1 && iteration.residual_norm() >= before ? without_progress + 1 : 0;
    const bool converged = iteration.in_balance() &&
                           (k == options.max_steps || without_progress > 0 || iteration.traction_settled());
    const NewtonIterate<dim> iterate{
        iteration.report(), iteration.contact_displacement(), iteration.traction(), converged,
        [&iteration] { return std::span<const double>(iteration.displacement()); }};
    const NewtonAdvice advice = observer ? observer(iterate) : false;
    result.steps.push_back(iteration.report());
    if (advice.delta)
    {
      iteration.regularise(*advice.delta);
      without_progress = 0;
      continue;
    }

    if (converged)
      result.status = NewtonStatus::converged;
    else if (advice.good_enough)
      result.status = NewtonStatus::accepted;
    else if ((options.damping && without_progress == 3) || !std::isfinite(iteration.residual_norm()))
    {
      result.status = NewtonStatus::diverged;
      result.message = fmt::format("at step {} no step length lowers the residual any more; {}", k,
                                   iteration.describe_residual());
      break;
    }
  }
  if (result.status == NewtonStatus::too_many_steps)
    result.message = fmt::format("step {} was the last of newton.max_steps; {}", options.max_steps,
                                 iteration.describe_residual());
  return result;
}

}  // namespace

template <int dim>
NewtonResult<dim> solve(const contact::NitscheForm<dim>& form, std::span<const double> start,
                        const NewtonOptions& newton, const algebra::SolverOptions& solver,
                        const NewtonObserver<dim>& observer, double delta,
                        std::shared_ptr<Equilibrium<dim>> equilibrium)
{
  const bool is_new = !form.space().mesh().ranks().any(!start.empty());  // a rank may have no cells
  if (!equilibrium) equilibrium = make_equilibrium(form, solver, is_new);
  NewtonIteration<dim> iteration(form, newton, solver.tolerance, delta, std::move(equilibrium));
  iteration.initialise(start);
  NewtonResult<dim> result = run(iteration, newton, is_new, observer);
  result.u = iteration.take_displacement();
  if (!result.steps.empty()) result.steps.back() = iteration.report();
  result.traction = std::move(iteration.traction());
  result.equilibrium = std::move(iteration.equilibrium());
  return result;
}

template NewtonResult<2> solve(const contact::NitscheForm<2>&, std::span<const double>, const NewtonOptions&,
                               const algebra::SolverOptions&, const NewtonObserver<2>&, double,
                               std::shared_ptr<Equilibrium<2>>);
template NewtonResult<3> solve(const contact::NitscheForm<3>&, std::span<const double>, const NewtonOptions&,
                               const algebra::SolverOptions&, const NewtonObserver<3>&, double,
                               std::shared_ptr<Equilibrium<3>>);

}  // namespace tribound::solve
