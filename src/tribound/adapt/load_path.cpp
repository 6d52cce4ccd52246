#include "tribound/adapt/load_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/nitsche/interface_check.h"
#include "tribound/contact/support/rigid_motion.h"

namespace tribound::adapt
{

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
}

template <int dim>
Method LoadPath<dim>::method_of_step() const
{
  Method method = method_;
  method.newton.reference_force = reference_force_;
  if (!last_) return method;
  method.full_steps = options_.full_steps;
  method.other_starts = false;
  return method;
}

/// Not empty: why Newton's method has not come to t.
template <int dim>
std::string LoadPath<dim>::try_step(double t, int cuts, const StepObserver& observer)
{
  auto step = std::make_shared<LoadStep<dim>>();
  step->number = last_ ? last_->number + 1 : 1;
  step->t = t;
  step->cuts = cuts;
  step->reference_force = reference_force_;
  const Method method = method_of_step();
  if (!last_ && (!prepared_ || prepared_->t != t)) prepare(t);
  step->at = last_ ? std::make_shared<const DiscreteAtTime<dim>>(problem_, t, grid_, method, history_)
                   : std::exchange(prepared_, nullptr);
  const contact::NitscheForm<dim>& form = step->at->discrete.form;
  const std::span<const double> start =
      last_ ? std::span<const double>(last_->level.u) : std::span<const double>();
  step->level = solve_and_certify<dim>(form, start, method, observer, 0, {}, friedrichs_);
  step->level.equilibrium.reset();
  friedrichs_ = step->level.friedrichs;
  if (!step->level.solved()) return step->level.failure;
  commit(std::move(step));
  return {};
}

template <int dim>
void LoadPath<dim>::prepare(double t)
{
  prepared_ = std::make_shared<DiscreteAtTime<dim>>(problem_, t, grid_, method_, nullptr);
  contact::NitscheForm<dim>& form = prepared_->discrete.form;
  history_ = contact::history_at_first(form);
  if (history_) form.set_history(history_);
  check(*prepared_);
}

template <int dim>
void LoadPath<dim>::check(const DiscreteAtTime<dim>& at)
{
  const contact::NitscheForm<dim>& form = at.discrete.form;
  const mesh::Mesh<dim>& mesh = at.discrete.mesh;
  contact::check_interfaces(form);
  if (is_well_posed_) return;
  if (!mesh.partition()) return contact::check_rigid_motions(form);
  mesh.ranks().on_first([&] { contact::check_rigid_motions(at.problem, *whole_, method_.degree); });
  friedrichs_ = mesh.ranks().on_first([&] { return certify::friedrichs_constant<dim>(at.problem, *whole_); });
  whole_.reset();
}

/// A cycle comes back to no stress at all: bound and identities are relative to the stress of the path,
/// ||sigma_h|| being at most ||sigma(u_h)|| and the bound.
template <int dim>
certify::Verdict LoadPath<dim>::judge(const CertifiedLevel<dim>& level) const
{
  contact::StressNorms norms = level.norms;
  norms.sigma = largest_sigma_;
  certify::IdentityDefects identities = level.identities;
  const double share = (level.norms.sigma + level.estimate.total) / largest_sigma_;
  if (share < 1)
    for (double* defect : {&identities.divergence, &identities.jump, &identities.neumann, &identities.contact,
                           &identities.symmetry})
      *defect *= share;
  return certify::judge(level.estimate, identities, method_.degree, norms, options_.tolerance);
}

template <int dim>
void LoadPath<dim>::commit(std::shared_ptr<LoadStep<dim>> step)
{
  const contact::NitscheForm<dim>& form = step->at->discrete.form;
  const CertifiedLevel<dim>& level = step->level;
  largest_sigma_ = std::max(largest_sigma_, level.norms.sigma);
  step->largest_sigma = largest_sigma_;
  step->verdict = judge(level);
  step->responses = form.advance(level.u);

  std::vector<problem::InterfaceState<dim>> states;
  states.reserve(step->responses.size());
  for (const auto& response : step->responses) states.push_back(response.state);
  history_ = std::make_shared<const contact::ContactHistory<dim>>(std::move(states), form.facet_rule(),
                                                                  method_.degree + 2);
  account(*step);
  step->seconds = seconds_since(begin_);
  begin_ = Clock::now();
  last_ = std::move(step);
}

template <int dim>
void LoadPath<dim>::account(LoadStep<dim>& step)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const fem::LagrangeSpace<dim>& space = form.space();
  const std::vector<double>& u = step.level.u;
  std::vector<double> contact_load(space.n_dofs(), 0.0);
  form.add_contact_load(step.level.traction, contact_load);
  reference_force_ =
      std::max(reference_force_, solve::external_forces(form).scale + space.norm(contact_load));

  step.forces = contact::apply_stiffness<dim>(form.problem(), space, u);
  for (std::size_t i = 0; i < u.size(); ++i) step.forces[i] -= contact_load[i];
  std::vector<double> mean = step.forces;
  std::vector<double> moved = u;
  if (last_)
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      mean[i] += last_->forces[i];
      moved[i] -= last_->level.u[i];
    }
  step.work = space.dot(mean, moved) / 2;
}

template <int dim>
std::string LoadPath<dim>::advance(double t, const Observer& observer, const StepObserver& step_observer)
{
  const Ranks& ranks = grid_->mesh.ranks();
  const auto interruption = [&]
  { return ranks.any(stop_ && *stop_) ? fmt::format("interrupted at t = {:.9g}", last_->t) : std::string(); };
  if (last_)
    if (std::string why = interruption(); !why.empty()) return why;
  const double whole = last_ ? t - last_->t : 0;  // the first step of all is not cut
  double size = whole;
  int cuts = 0;
  begin_ = Clock::now();
  for (;;)
  {
    const bool arrives = !last_ || std::abs(t - last_->t) <= std::abs(size) * (1 + 1e-10);
    const double to = arrives ? t : last_->t + size;
    std::string failure;
    try
    {
      failure = try_step(to, cuts, step_observer);
    }
    catch (const SolveError& error)
    {
      require_all_failed(ranks, error.what());
      failure = error.what();
    }
    if (failure.empty())
    {
      if (observer) observer(*last_);
      if (arrives) return {};
      cuts = 0;
      if (static_cast<int>(last_->level.steps.size()) <= options_.few_steps) size *= options_.growth;
      if (std::abs(size) > std::abs(whole)) size = whole;
    }
    else if (std::abs(size) / 2 <= options_.smallest * std::abs(whole))
      return fmt::format("load step {} at t = {:.9g}: {}", last_ ? last_->number + 1 : 1, to, failure);
    else
    {
      size /= 2;
      ++cuts;
    }
    if (std::string why = interruption(); !why.empty()) return why;
  }
}

template struct DiscreteAtTime<2>;
template struct DiscreteAtTime<3>;
template class LoadPath<2>;
template class LoadPath<3>;

}  // namespace tribound::adapt
