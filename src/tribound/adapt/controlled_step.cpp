/// @file controlled_step.cpp
/// Load steps along which t is not prescribed.

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "tribound/adapt/load_path.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"

namespace tribound::adapt
{

/// The step that begins with theta times the previous step.
template <int dim>
std::string LoadPath<dim>::try_control(const Control<dim>& control, double theta,
                                       const StepObserver& observer)
{
  const LoadStep<dim>& now = *last();
  const PathPoint& before = position_.before_last;
  PathPoint point{now.t + theta * (now.t - before.t), now.level.u};
  for (std::size_t i = 0; i < point.u.size(); ++i) point.u[i] += theta * (now.level.u[i] - before.u[i]);

  if (!bordered_)
    bordered_ = std::make_shared<Bordered<dim>>(
        typename Bordered<dim>::Form(last()->at, &now.at->discrete.form), method_.solver);
  const double target = control.measure.value(now.at->discrete.form, now.level.u) + control.increment;
  const BorderedOptions options{
      .max_steps = options_.full_steps,
      .tolerance = method_.newton.tolerance,
      .measure_tolerance = std::max(1e-10 * std::abs(target), 1e-7 * std::abs(control.increment)),
      .force = position_.reference_force,
      .t_before = now.t,
      .largest_change = control.largest_change,
      .difference = 1e-6 * control.largest_change};
  const auto search =
      [&](std::span<const double> tips, PathPoint& from, std::vector<solve::NewtonStep>& steps)
  {
    const auto form_at = [&](double t)
    {
      const std::shared_ptr<const DiscreteAtTime<dim>> at = at_time(t, tips);
      return typename Bordered<dim>::Form(at, &at->discrete.form);
    };
    const auto note = [&](const solve::NewtonStep& step)
    {
      steps.push_back(step);
      if (observer) observer({step, {}});
    };
    return (*bordered_)(form_at, control.measure, target, options, from, note);
  };
  const auto fault = [&](const contact::NitscheForm<dim>& form, std::span<const double> u)
  {
    constexpr double most = 1e-3;  // of the increment; Newton's method at t moves by its tolerance
    const bool left = std::abs(control.measure.value(form, u) - target) > most * std::abs(control.increment);
    return std::string(left ? "Newton's method leaves the path that was found for u and t" : "");
  };
  try
  {
    return try_step({.t = point.t,
                     .cuts = control.cuts,
                     .control = control.name,
                     .start = std::move(point.u),
                     .search = search,
                     .fault = fault},
                    observer);
  }
  catch (const InputError& error)  // invalid data at the t of an iterate
  {
    require_all_failed(grid_->mesh.ranks(), error.what());
    return error.what();
  }
}

template <int dim>
std::string LoadPath<dim>::follow(const Control<dim>& control, const Observer& observer,
                                  const StepObserver& step_observer)
{
  assert(last() && last()->number > 1);
  if (std::string why = interruption(); !why.empty()) return why;
  begin_ = Clock::now();
  const double usual = control.last_increment != 0 ? control.increment / control.last_increment : 1;
  std::vector<double> thetas = {usual, 2 * usual, 0.5 * usual};
  const double last_change = last()->t - position_.before_last.t;
  if (control.failed && last_change != 0)
    for (const double part : {1.0, 0.5, 0.25})
      thetas.push_back(part * (*control.failed - last()->t) / last_change);
  std::string failure;
  for (const double theta : thetas)
  {
    failure = guarded([&] { return try_control(control, theta, step_observer); });
    if (failure.empty())
    {
      if (observer) observer(*last());
      return {};
    }
    if (std::string why = interruption(); !why.empty()) return why;
  }
  return fmt::format("load step {} by {}, after t = {:.9g}: {}", last()->number + 1, control.name, last()->t,
                     failure);
}

template std::string LoadPath<2>::follow(const Control<2>&, const Observer&, const StepObserver&);
template std::string LoadPath<3>::follow(const Control<3>&, const Observer&, const StepObserver&);

}  // namespace tribound::adapt
