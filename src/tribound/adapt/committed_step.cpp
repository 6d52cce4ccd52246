/// @file committed_step.cpp
/// The results of a load step whose Newton iteration has converged: verdict, history, forces and work.

#include <algorithm>
#include <utility>

#include "tribound/adapt/load_path.h"

namespace tribound::adapt
{

template <int dim>
std::vector<double> forces_on(const contact::NitscheForm<dim>& form, std::span<const double> u,
                              std::span<const double> contact_load)
{
  std::vector<double> forces =
      contact::apply_stiffness<dim>(form.problem(), form.space(), u, form.meridian());
  for (std::size_t i = 0; i < u.size(); ++i) forces[i] -= contact_load[i];
  return forces;
}

/// A load cycle returns to zero stress, so bound and identities are relative to the largest stress of the
/// path. ||sigma_h|| is at most ||sigma(u_h)|| plus the bound.
template <int dim>
certify::Verdict LoadPath<dim>::judge(const CertifiedLevel<dim>& level) const
{
  contact::StressNorms norms = level.norms;
  norms.sigma = position_.largest_sigma;
  certify::IdentityDefects identities = level.identities;
  const double share = (level.norms.sigma + level.estimate.total) / position_.largest_sigma;
  if (share < 1)
    for (double* defect : {&identities.divergence, &identities.jump, &identities.neumann, &identities.contact,
                           &identities.symmetry})
      *defect *= share;
  return certify::judge(level.estimate, identities, norms, options_.tolerance);
}

template <int dim>
void LoadPath<dim>::commit(std::shared_ptr<LoadStep<dim>> step)
{
  const CertifiedLevel<dim>& level = step->level;
  position_.largest_sigma = std::max(position_.largest_sigma, level.norms.sigma);
  step->largest_sigma = position_.largest_sigma;
  step->verdict = options_.certifies ? judge(level) : certify::Verdict{certify::RunStatus::uncertified, {}};
  if (options_.certifies && has_error_bars_) bound_energy(*step);
  for (std::size_t i = 0; i < position_.tips.size(); ++i) position_.tips[i] = step->crack_tips[i].distance;

  position_.history = history_after(*step);
  account(*step);
  step->seconds = seconds_since(begin_);
  begin_ = Clock::now();
  if (last()) position_.before_last = {last()->t, last()->level.u};
  position_.last = std::move(step);
}

template <int dim>
void LoadPath<dim>::bound_energy(LoadStep<dim>& step) const
{
  CertifiedLevel<dim>& level = step.level;
  const ScopedTimer timer(level.certify_seconds, level.certify_cpu);
  level.energy = error_bars<dim>(step.at->discrete.form, method_, level, step.verdict, quantities_);
}

template <int dim>
std::shared_ptr<const contact::ContactHistory<dim>> LoadPath<dim>::history_after(
    const LoadStep<dim>& step) const
{
  std::vector<problem::InterfaceState<dim>> states;
  states.reserve(step.responses.size());
  for (const auto& response : step.responses) states.push_back(response.state);
  return std::make_shared<const contact::ContactHistory<dim>>(
      std::move(states), step.at->discrete.form.facet_rule(), method_.degree + 2);
}

template <int dim>
void LoadPath<dim>::account(LoadStep<dim>& step)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const fem::LagrangeSpace<dim>& space = form.space();
  const std::vector<double>& u = step.level.u;
  std::vector<double> contact_load(space.n_dofs(), 0.0);
  form.add_contact_load(step.level.traction, contact_load);
  position_.reference_force =
      std::max(position_.reference_force, solve::external_forces(form).scale + space.norm(contact_load));

  form.add_contact_load(form.water_pressure(), contact_load);  // the effective traction is stored
  step.forces = forces_on<dim>(form, u, contact_load);
  std::vector<double> mean = step.forces;
  std::vector<double> moved = u;
  if (last())
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      mean[i] += last()->forces[i];
      moved[i] -= last()->level.u[i];
    }
  step.work = space.dot(mean, moved) / 2;
}

template std::vector<double> forces_on(const contact::NitscheForm<2>&, std::span<const double>,
                                       std::span<const double>);
template std::vector<double> forces_on(const contact::NitscheForm<3>&, std::span<const double>,
                                       std::span<const double>);
template void LoadPath<2>::bound_energy(LoadStep<2>&) const;
template void LoadPath<3>::bound_energy(LoadStep<3>&) const;
template void LoadPath<2>::commit(std::shared_ptr<LoadStep<2>>);
template void LoadPath<3>::commit(std::shared_ptr<LoadStep<3>>);
template std::shared_ptr<const contact::ContactHistory<2>> LoadPath<2>::history_after(
    const LoadStep<2>&) const;
template std::shared_ptr<const contact::ContactHistory<3>> LoadPath<3>::history_after(
    const LoadStep<3>&) const;

}  // namespace tribound::adapt
