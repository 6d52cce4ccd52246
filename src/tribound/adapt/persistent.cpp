#include "tribound/adapt/persistent.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/adapt/regularisation.h"
#include "tribound/base/error.h"

namespace tribound
{

namespace
{

/// The solution with a small delta, from larger ones; nothing where that fails, too.
template <int dim>
std::optional<std::vector<double>> regularised_start(const NitscheForm<dim>& form,
                                                     std::span<const double> start, const Config& config,
                                                     const std::function<void(const NewtonStep&)>& record)
{
  // In units of the mean contact traction of the first step.
  constexpr double first = 10;
  constexpr double last = 1e-3;
  constexpr double factor = 0.25;
  NewtonConfig newton = config.newton;
  newton.tolerance = std::max(newton.tolerance, 1e-4);
  double scale = 0;
  double delta = 0;
  const NewtonObserver<dim> shrink = [&](const NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    NewtonAdvice advice = false;
    if (delta == 0)
    {
      scale = mean_contact_traction<dim>(form, iterate.traction);
      delta = first * scale;
      if (delta > 0) advice.delta = delta;
    }
    else if (iterate.converged)
    {
      delta *= factor;
      if (delta > last * scale)
        advice.delta = delta;
      else
        advice.good_enough = true;
    }
    return advice;
  };
  NewtonResult<dim> result = solve<dim>(form, start, newton, config.solver, shrink);
  if (result.status == NewtonStatus::diverged || delta == 0) return std::nullopt;
  return std::move(result.u);
}

/// The solution with gamma times `factor`; nothing where that fails, too.
template <int dim>
std::optional<std::vector<double>> start_with_gamma(double factor, const NitscheForm<dim>& form,
                                                    std::span<const double> start, const Config& config,
                                                    const std::function<void(const NewtonStep&)>& record)
{
  const NitscheForm<dim> other(form.problem(), form.space(), factor * form.gamma0());
  const NewtonObserver<dim> watch = [&](const NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    return false;
  };
  NewtonResult<dim> result = solve<dim>(other, start, config.newton, config.solver, watch);
  if (!result.message.empty()) return std::nullopt;
  return std::move(result.u);
}

}  // namespace

template <int dim>
NewtonResult<dim> solve_persistently(const NitscheForm<dim>& form, std::span<const double> start,
                                     const Config& config, const NewtonObserver<dim>& observer, double delta,
                                     const std::function<void(const NewtonStep&)>& record)
{
  const auto attempt = [&](std::span<const double> u)
  { return solve<dim>(form, u, config.newton, config.solver, observer, delta); };
  NewtonResult<dim> first;
  std::exception_ptr failure;
  try
  {
    first = attempt(start);
  }
  catch (const SolveError&)
  {
    failure = std::current_exception();
  }
  if (!failure && first.message.empty()) return first;

  const bool worth_it = config.newton.damping && !config.regularisation && form.problem().has_contact();
  using Start = std::function<std::optional<std::vector<double>>()>;
  std::vector<Start> others;
  if (worth_it)
    others = {[&] { return regularised_start(form, start, config, record); },
              [&] { return start_with_gamma(3, form, start, config, record); },
              [&] { return start_with_gamma(1. / 3, form, start, config, record); }};
  for (const Start& other : others) try
    {
      if (const auto better = other())
        if (NewtonResult<dim> result = attempt(*better); result.message.empty()) return result;
    }
    catch (const SolveError&)
    {
    }
  if (failure) std::rethrow_exception(failure);
  return first;
}

template NewtonResult<2> solve_persistently(const NitscheForm<2>&, std::span<const double>, const Config&,
                                            const NewtonObserver<2>&, double,
                                            const std::function<void(const NewtonStep&)>&);
template NewtonResult<3> solve_persistently(const NitscheForm<3>&, std::span<const double>, const Config&,
                                            const NewtonObserver<3>&, double,
                                            const std::function<void(const NewtonStep&)>&);

}  // namespace tribound
