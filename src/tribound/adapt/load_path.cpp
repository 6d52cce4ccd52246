#include "tribound/adapt/load_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "tribound/adapt/contact_hold.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/nitsche/interface_check.h"
#include "tribound/contact/support/rigid_motion.h"

namespace tribound::adapt
{

namespace
{

/// Puts steps without a bound before those with one, and numbers all anew.
void put_before(std::span<const solve::NewtonStep> first, std::vector<CertifiedStep>& steps)
{
  std::vector<CertifiedStep> all;
  for (const solve::NewtonStep& step : first) all.push_back({step, {}});
  std::ranges::move(steps, std::back_inserter(all));
  for (std::size_t i = 0; i < all.size(); ++i) all[i].step.step = static_cast<int>(i) + 1;
  steps = std::move(all);
}

/// Whether the displacement has diverged. Where a body slides away, u may become so large that the residual
/// is all rounding, which would pass for a solution.
bool has_run_away(const std::vector<CertifiedStep>& steps, const Method& method)
{
  const double largest = std::max(1e-6, method.newton.tolerance);  // residual of a solution, over the forces
  const Stopping criterion = method.stopping.criterion;
  const bool is_solved_to_the_end = criterion == Stopping::tolerance || criterion == Stopping::last_bounded;
  return is_solved_to_the_end && steps.back().step.residual > largest;
}

}  // namespace

template <int dim>
DiscreteAtTime<dim>::DiscreteAtTime(const problem::Problem<dim>& general, double load_factor,
                                    std::shared_ptr<const Grid<dim>> grid, const Method& method,
                                    std::shared_ptr<const contact::ContactHistory<dim>> history)
    : t(load_factor), problem(general.at(load_factor)), discrete(std::move(grid), problem, method)
{
  if (history) discrete.form.set_history(std::move(history));
}

template <int dim>
LoadPath<dim>::LoadPath(const problem::Problem<dim>& problem, const Method& method,
                        const PathOptions& options, mesh::Mesh<dim> mesh, const std::atomic<bool>* stop,
                        std::shared_ptr<const mesh::Mesh<dim>> whole)
    : problem_(problem),
      method_(method),
      options_(options),
      grid_(std::make_shared<const Grid<dim>>(contact::with_partners<dim>(std::move(mesh), problem.pairs()),
                                              method.degree)),
      stop_(stop),
      whole_(std::move(whole))
{
  position_.tips.assign(problem.contacts().size(), 0.0);
  if (method.regularisation)
    throw InputError({}, "the regularised variant does not go along a load path",
                     "the plain method: no regularisation");
}

template <int dim>
LoadPath<dim>::LoadPath(const LoadPath& coarser, mesh::Mesh<dim> mesh)
    : LoadPath(coarser.problem_, coarser.method_, coarser.options_, std::move(mesh), coarser.stop_)
{
  friedrichs_ = coarser.friedrichs_;
  is_well_posed_ = true;
  has_error_bars_ = coarser.has_error_bars_;
  quantities_ = coarser.quantities_;
}

template <int dim>
Method LoadPath<dim>::method_of_step() const
{
  Method method = method_;
  method.newton.reference_force = position_.reference_force;
  if (!last()) return method;
  method.full_steps = options_.full_steps;
  method.other_starts = false;
  return method;
}

/// Returns why Newton's method has failed at t; empty on success.
template <int dim>
std::string LoadPath<dim>::try_step(const Attempt& attempt, const StepObserver& observer)
{
  auto step = std::make_shared<LoadStep<dim>>();
  step->number = last() ? last()->number + 1 : 1;
  step->t = attempt.t;
  step->cuts = attempt.cuts;
  step->control = attempt.control;
  step->reference_force = position_.reference_force;
  solve_with_crack(*step, attempt, observer);
  if (!step->level.solved()) return step->level.failure;
  if (has_run_away(step->level.steps, method_)) return "the displacement diverges";
  if (attempt.fault)
    if (std::string why = attempt.fault(step->at->discrete.form, step->level.u); !why.empty()) return why;
  commit(std::move(step));
  return {};
}

template <int dim>
void LoadPath<dim>::solve_with_crack(LoadStep<dim>& step, const Attempt& attempt,
                                     const StepObserver& observer)
{
  const Method method = method_of_step();
  std::vector<double> tips = position_.tips;
  PathPoint point{attempt.t, attempt.start};
  if (point.u.empty() && last()) point.u = last()->level.u;
  for (step.passes = 1;; ++step.passes)
  {
    std::vector<solve::NewtonStep> found_by;
    if (attempt.search)
    {
      step.level.failure = attempt.search(tips, point, found_by);
      if (!step.level.solved()) return;
      step.t = point.t;
    }
    if (!last() && step.passes == 1)
    {
      if (!prepared_ || prepared_->t != step.t) prepare(step.t);
      step.at = std::exchange(prepared_, nullptr);
    }
    else
      step.at = at_time(step.t, tips);
    const contact::NitscheForm<dim>& form = step.at->discrete.form;
    contact::check_interface_data(form);
    if (equilibrium_) equilibrium_->follow(form);
    std::shared_ptr<solve::Equilibrium<dim>> equilibrium = std::exchange(equilibrium_, nullptr);
    step.level = options_.certifies
                     ? solve_and_certify<dim>(form, point.u, method, observer, 0, {}, friedrichs_,
                                              std::move(equilibrium))
                     : solve_without_bound<dim>(form, point.u, method, observer, std::move(equilibrium));
    equilibrium_ = std::move(step.level.equilibrium);
    friedrichs_ = step.level.friedrichs;
    if (!step.level.solved()) return;
    put_before(found_by, step.level.steps);
    if (!attempt.start.empty() || step.passes > 1) step.start = std::move(point.u);
    if (!crack_grows(step, tips)) return;
    point.u = step.level.u;
  }
}

template <int dim>
bool LoadPath<dim>::crack_grows(LoadStep<dim>& step, std::vector<double>& tips) const
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  step.responses = form.advance(step.level.u);
  step.crack_tips = contact::crack_tips<dim>(form, step.responses);
  bool grows = false;
  const std::vector<const problem::Contact*> contacts = form.problem().contacts();
  for (std::size_t i = 0; i < tips.size(); ++i)
  {
    contact::CrackTip& tip = step.crack_tips[i];
    const bool matters = contacts[i]->water && contacts[i]->water->follows_crack();
    grows = grows || (matters && tip.distance > tips[i]);
    tips[i] = tip.distance = std::max(tip.distance, tips[i]);
  }
  return grows;
}

template <int dim>
const Discretisation<dim>& LoadPath<dim>::prepare(double t)
{
  prepared_ = std::make_shared<DiscreteAtTime<dim>>(problem_, t, grid_, method_, nullptr);
  contact::NitscheForm<dim>& form = prepared_->discrete.form;
  position_.history = contact::history_at_first(form);
  if (position_.history) form.set_history(position_.history);
  check(*prepared_);
  return prepared_->discrete;
}

template <int dim>
void LoadPath<dim>::check(const DiscreteAtTime<dim>& at)
{
  const contact::NitscheForm<dim>& form = at.discrete.form;
  const mesh::Mesh<dim>& mesh = at.discrete.mesh;
  contact::check_interfaces(form);
  if (is_well_posed_ || !options_.certifies) return;
  if (!mesh.partition()) return contact::check_rigid_motions(form);
  mesh.ranks().on_first([&] { contact::check_rigid_motions(at.problem, *whole_, method_.degree); });
  friedrichs_ = mesh.ranks().on_first([&] { return certify::friedrichs_constant<dim>(at.problem, *whole_); });
  whole_.reset();
}

template <int dim>
void LoadPath<dim>::go_back(Position position, std::shared_ptr<const Grid<dim>> grid)
{
  if (position.last)
  {
    grid = position.last->at->discrete.grid;
    if (grid != grid_) friedrichs_ = position.last->level.friedrichs;  // of a coarser mesh
  }
  position_ = std::move(position);
  if (!grid || grid == grid_) return;
  bordered_.reset();
  equilibrium_.reset();
  grid_ = std::move(grid);
  is_well_posed_ = true;
}

template <int dim>
std::string LoadPath<dim>::repeat(const LoadStep<dim>& step, const std::vector<double>& start,
                                  const StepObserver& newton)
{
  constexpr double most = 0.5;
  begin_ =
      Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step.seconds));
  const auto fault = [&](const contact::NitscheForm<dim>& form, std::span<const double> u)
  {
    std::vector<double> change(u.begin(), u.end());
    for (std::size_t i = 0; i < change.size(); ++i) change[i] -= start[i];
    const double moved = contact::stress_norms<dim>(form.problem().without_initial_stress(), form.space(),
                                                    change, nullptr, form.meridian())
                             .sigma;
    return std::string(moved > most * step.level.norms.sigma ? "the solution is on another branch" : "");
  };
  Attempt attempt{.t = step.t, .cuts = step.cuts, .control = step.control, .start = start};
  if (step.control != "load") attempt.fault = fault;
  std::string why = guarded([&] { return try_step(attempt, newton); });
  if (why.empty() || !last()) return why;
  attempt.start = last()->level.u;
  return guarded([&] { return try_step(attempt, newton); });
}

template <int dim>
std::string LoadPath<dim>::interruption() const
{
  const bool ends = last() && grid_->mesh.ranks().any(stop_ && *stop_);
  return ends ? fmt::format("interrupted at t = {:.9g}", last()->t) : std::string();
}

template <int dim>
std::string LoadPath<dim>::guarded(const std::function<std::string()>& step) const
{
  try
  {
    return step();
  }
  catch (const SolveError& error)
  {
    require_all_failed(grid_->mesh.ranks(), error.what());
    return error.what();
  }
}

template <int dim>
std::string LoadPath<dim>::advance(double t, const Observer& observer, const StepObserver& step_observer,
                                   bool may_cut, LoadProgress& progress)
{
  if (std::string why = interruption(); !why.empty()) return why;
  double& whole = progress.whole;
  double& size = progress.size;
  int& cuts = progress.cuts;
  if (whole == 0 && last()) whole = size = t - last()->t;  // the very first step is not halved
  begin_ = Clock::now();
  for (;;)
  {
    const bool arrives = !last() || std::abs(t - last()->t) <= std::abs(size) * (1 + 1e-10);
    const double to = arrives ? t : last()->t + size;
    const std::string failure = guarded([&] { return try_step({.t = to, .cuts = cuts}, step_observer); });
    if (failure.empty())
    {
      cuts = 0;
      if (static_cast<int>(last()->level.steps.size()) <= options_.few_steps) size *= options_.growth;
      if (std::abs(size) > std::abs(whole)) size = whole;
      if (arrives) progress = {};
      if (observer) observer(*last());
      if (arrives) return {};
    }
    else if (!may_cut || std::abs(size) / 2 <= options_.smallest * std::abs(whole))
      return fmt::format("load step {} at t = {:.9g}: {}{}", last() ? last()->number + 1 : 1, to, failure,
                         words_of_statics(problem_.with_crack_tips(position_.tips).at(t), grid_->space, t));
    else
    {
      size /= 2;
      ++cuts;
    }
    if (std::string why = interruption(); !why.empty()) return why;
  }
}

template <int dim>
std::shared_ptr<const DiscreteAtTime<dim>> LoadPath<dim>::at_time(double t,
                                                                  std::span<const double> tips) const
{
  return std::make_shared<const DiscreteAtTime<dim>>(problem_.with_crack_tips(tips), t, grid_, method_,
                                                     position_.history);
}

template struct DiscreteAtTime<2>;
template struct DiscreteAtTime<3>;
template class LoadPath<2>;
template class LoadPath<3>;

}  // namespace tribound::adapt
