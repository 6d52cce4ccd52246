#include "tribound/adapt/persistent.h"

#include <algorithm>
#include <exception>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/adapt/regularisation.h"
#include "tribound/base/error.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/fem/nested.h"

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

/// The solution of another form; nothing where Newton's method fails.
template <int dim>
std::optional<std::vector<double>> solution_of(const contact::NitscheForm<dim>& other,
                                               std::span<const double> start, const Method& method,
                                               double tolerance,
                                               const std::function<void(const solve::NewtonStep&)>& record)
{
  solve::NewtonOptions newton = method.newton;
  newton.tolerance = std::max(newton.tolerance, tolerance);
  const solve::NewtonObserver<dim> watch = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    return false;
  };
  solve::NewtonResult<dim> result = solve::solve<dim>(other, start, newton, method.solver, watch);
  if (!result.message.empty()) return std::nullopt;
  return std::move(result.u);
}

/// The solution with gamma times `factor`; nothing where that fails, too.
template <int dim>
std::optional<std::vector<double>> start_with_gamma(
    double factor, const contact::NitscheForm<dim>& form, std::span<const double> start, const Method& method,
    const std::function<void(const solve::NewtonStep&)>& record)
{
  const contact::NitscheForm<dim> other(form.problem(), form.space(), factor * form.gamma0());
  return solution_of(other, start, method, 0, record);
}

/// The solution with half the degree, rounded up, on the same mesh, as far as a start needs it; it starts
/// likewise. Nothing where Newton's method fails.
template <int dim>
std::optional<std::vector<double>> start_of_lower_degree(
    const contact::NitscheForm<dim>& form, const Method& method,
    const std::function<void(const solve::NewtonStep&)>& record)
{
  constexpr double tolerance = 1e-4;
  const int degree = (form.space().degree() + 1) / 2;
  const fem::LagrangeSpace<dim> space(form.space().mesh(), degree);
  const contact::NitscheForm<dim> other(form.problem(), space, contact::default_gamma0(degree));
  try
  {
    std::optional<std::vector<double>> start;
    if (degree > 1) start = start_of_lower_degree(other, method, record);
    const auto u = solution_of<dim>(other, start.value_or(std::vector<double>{}), method, tolerance, record);
    if (!u) return std::nullopt;
    std::vector<Index> itself(space.mesh().n_cells());
    std::iota(itself.begin(), itself.end(), 0);
    return fem::nested_interpolant<dim>(space, *u, itself, form.space());
  }
  catch (const SolveError&)
  {
    return std::nullopt;
  }
}

}  // namespace

template <int dim>
solve::NewtonResult<dim> solve_persistently(const contact::NitscheForm<dim>& form,
                                            std::span<const double> start, const Method& method,
                                            const solve::NewtonObserver<dim>& observer, double delta,
                                            const std::function<void(const solve::NewtonStep&)>& record)
{
  const bool may_start_anew = method.newton.damping && !method.regularisation && form.problem().has_contact();
  std::optional<std::vector<double>> of_lower_degree;
  if (dim == 3 && form.space().degree() > 1 && start.empty() && may_start_anew)
    of_lower_degree = start_of_lower_degree(form, method, record);

  solve::NewtonResult<dim> first;
  const auto attempt = [&](std::span<const double> u)
  { return solve::solve<dim>(form, u, method.newton, method.solver, observer, delta, first.equilibrium); };
  std::exception_ptr failure;
  try
  {
    first = attempt(of_lower_degree ? *of_lower_degree : start);
  }
  catch (const SolveError&)
  {
    failure = std::current_exception();
  }
  if (!failure && first.message.empty()) return first;

  using Start = std::function<std::optional<std::vector<double>>()>;
  std::vector<Start> others;
  if (of_lower_degree) others.emplace_back([] { return std::vector<double>{}; });
  if (may_start_anew)
    others.insert(others.end(), {[&] { return regularised_start(form, start, method, record); },
                                 [&] { return start_with_gamma(3, form, start, method, record); },
                                 [&] { return start_with_gamma(1. / 3, form, start, method, record); }});
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
