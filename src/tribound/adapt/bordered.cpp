#include "tribound/adapt/bordered.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/base/clock.h"
#include "tribound/base/error.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::adapt
{

/// The discrete problem at an iterate.
template <int dim>
struct Bordered<dim>::State
{
  /// Gives prescribed displacements their values at t.
  State(Form at_t, PathPoint& point, const PathMeasure<dim>& of_path);

  Form form;
  std::vector<double> residual;  ///< L - a(u, phi_i) + (T, phi_i)_C, 0 at fixed degrees of freedom
  double norm = 0;               ///< norm of the residual
  double measure = 0;            ///< C(u)
};

namespace
{

/// Tangents are unsymmetric and change, so condensation is not worth its own code here.
algebra::SolverOptions of_whole_matrix(algebra::SolverOptions options)
{
  if (options.method == algebra::LinearMethod::condensed) options.method = algebra::LinearMethod::automatic;
  return options;
}

}  // namespace

template <int dim>
Bordered<dim>::Bordered(Form form, const algebra::SolverOptions& solver)
    : form_(std::move(form)), equilibrium_(solve::whole_equilibrium<dim>(*form_, of_whole_matrix(solver)))
{
}

template <int dim>
Bordered<dim>::~Bordered() = default;

template <int dim>
Bordered<dim>::State::State(Form at_t, PathPoint& point, const PathMeasure<dim>& of_path)
    : form(std::move(at_t))
{
  form->prescribe(point.u);
  residual = contact::residual<dim>(*form, point.u, form->traction(point.u));
  norm = form->space().norm(residual);
  measure = of_path.value(*form, point.u);
}

/// One Newton step from `now`; `then` is the same problem at a slightly later t.
template <int dim>
void Bordered<dim>::move(const State& now, const State& then, const PathMeasure<dim>& measure, double target,
                         const BorderedOptions& options, PathPoint& point, solve::NewtonStep& step)
{
  const contact::NitscheForm<dim>& form = *now.form;
  const solve::Linearised<dim> tangent{contact::Linearisation::newton, point.u};
  const auto solve = [&](std::span<const double> r, std::vector<double>& d)
  {
    d.assign(r.size(), 0.0);
    const double tolerance =
        std::max(0.01 * options.tolerance * options.force, 1e-12 * equilibrium_->norm(r));
    const algebra::LinearSolve linear = equilibrium_->solve(form, tangent, r, tolerance, d, {});
    step.linear_iterations += linear.iterations;
    step.factorised = step.factorised || linear.factorised;
    step.fell_back = step.fell_back || linear.fell_back;
  };
  std::vector<double> d;
  solve(now.residual, d);

  std::vector<double> rate(d.size());
  for (std::size_t i = 0; i < d.size(); ++i)
    rate[i] = (then.residual[i] - now.residual[i]) / options.difference;
  std::vector<double> d_rate;
  solve(rate, d_rate);

  const auto [along_d, along_rate] = measure.derivatives(form, point.u, {d, d_rate});
  const double dt =
      (target - now.measure - along_d) / (along_rate + (then.measure - now.measure) / options.difference);
  for (std::size_t i = 0; i < d.size(); ++i) point.u[i] += d[i] + dt * d_rate[i];
  point.t += dt;
  step.method = equilibrium_->method();
}

template <int dim>
std::string Bordered<dim>::operator()(const FormAt& form_at, const PathMeasure<dim>& measure, double target,
                                      const BorderedOptions& options, PathPoint& point,
                                      const std::function<void(const solve::NewtonStep&)>& observer)
{
  solve::NewtonStep step;
  for (int k = 0;; ++k)
  {
    const Clock::time_point begin = Clock::now();
    const State now(form_at(point.t), point, measure);
    const double tolerance = std::max(options.tolerance * options.force, equilibrium_->round_off(point.u));
    if (k > 0)
    {
      step.residual = options.force > 0 ? now.norm / options.force : now.norm;
      if (observer) observer(step);
    }
    if (now.norm <= tolerance && std::abs(now.measure - target) <= options.measure_tolerance) return {};
    if (!std::isfinite(now.norm) || !std::isfinite(now.measure)) return "its iterates diverge";
    if (k == options.max_steps)
      return fmt::format("{} steps of Newton's method for u and t are not enough", k);
    step = {.step = k + 1, .degree = now.form->space().degree(), .gamma0 = now.form->gamma0()};
    PathPoint later{point.t + options.difference, point.u};
    const State then(form_at(later.t), later, measure);
    move(now, then, measure, target, options, point, step);
    step.seconds = seconds_since(begin);
    if (!std::isfinite(point.t)) return "the prescribed data do not change with t there";
    if (!(std::abs(point.t - options.t_before) <= options.largest_change))
      return fmt::format("t would change by more than {:.6g}, the largest step of the list",
                         options.largest_change);
  }
}

template class Bordered<2>;
template class Bordered<3>;

}  // namespace tribound::adapt
