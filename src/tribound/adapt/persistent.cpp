#include "tribound/adapt/persistent.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/adapt/regularisation.h"
#include "tribound/base/error.h"

namespace tribound::adapt
{

namespace
{

/// The solution with a small delta, from larger ones; nothing where that fails, too.
template <int dim>
std::optional<std::vector<double>> regularised_start(
    const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const std::function<void(const solve::NewtonStep&)>& record)
{
  // In units of the mean contact traction of the first step.
  constexpr double first = 10;
  constexpr double last = 1e-3;
  constexpr double factor = 0.25;
  solve::NewtonOptions newton = method.newton;
  newton.tolerance = std::max(newton.tolerance, 1e-4);
  double scale = 0;
  double delta = 0;
  const solve::NewtonObserver<dim> shrink = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    solve::NewtonAdvice advice = false;
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
  solve::NewtonResult<dim> result = solve::solve<dim>(form, start, newton, method.solver, shrink);
  if (result.status == solve::NewtonStatus::diverged || delta == 0) return std::nullopt;
  return std::move(result.u);
}

/// The solution with gamma times `factor`; nothing where that fails, too.
template <int dim>
std::optional<std::vector<double>> start_with_gamma(
    double factor, const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const std::function<void(const solve::NewtonStep&)>& record)
{
  const contact::NitscheForm<dim> other(form.problem(), form.space(), factor * form.gamma0());
  const solve::NewtonObserver<dim> watch = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    return false;
  };
  solve::NewtonResult<dim> result = solve::solve<dim>(other, start, method.newton, method.solver, watch);
  if (!result.message.empty()) return std::nullopt;
  return std::move(result.u);
}

}  // namespace

template <int dim>
solve::NewtonResult<dim> solve_persistently(const contact::NitscheForm<dim>& form,
                                            std::span<const double> start, const Method& method,
                                            const solve::NewtonObserver<dim>& observer, double delta,
                                            const std::function<void(const solve::NewtonStep&)>& record)
{
  solve::NewtonResult<dim> first;
  const auto attempt = [&](std::span<const double> u)
  { return solve::solve<dim>(form, u, method.newton, method.solver, observer, delta, first.equilibrium); };
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

  const bool worth_it = method.newton.damping && !method.regularisation && form.problem().has_contact();
  using Start = std::function<std::optional<std::vector<double>>()>;
  std::vector<Start> others;
  if (worth_it)
    others = {[&] { return regularised_start(form, start, method, record); },
              [&] { return start_with_gamma(3, form, start, method, record); },
              [&] { return start_with_gamma(1. / 3, form, start, method, record); }};
  for (const Start& other : others) try
    {
      if (const auto better = other())
        if (solve::NewtonResult<dim> result = attempt(*better); result.message.empty()) return result;
    }
    catch (const SolveError&)
    {
    }
  if (failure) std::rethrow_exception(failure);
  return first;
}

template solve::NewtonResult<2> solve_persistently(const contact::NitscheForm<2>&, std::span<const double>,
                                                   const Method&, const solve::NewtonObserver<2>&, double,
                                                   const std::function<void(const solve::NewtonStep&)>&);
template solve::NewtonResult<3> solve_persistently(const contact::NitscheForm<3>&, std::span<const double>,
                                                   const Method&, const solve::NewtonObserver<3>&, double,
                                                   const std::function<void(const solve::NewtonStep&)>&);

}  // namespace tribound::adapt
