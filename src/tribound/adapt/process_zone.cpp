#include "tribound/adapt/process_zone.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tribound::adapt
{

template <int dim>
std::optional<PathMeasure<dim>> zone_measure(const contact::NitscheForm<dim>& form,
                                             std::span<const problem::InterfaceResponse<dim>> responses,
                                             std::span<const double> u_before, std::span<const double> u)
{
  const std::size_t n = form.n_segment_points();
  std::vector<Point<dim>> change(form.n_contact_points(), Point<dim>::Zero());
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const std::vector<contact::ContactState<dim>> before = form.contact_states(u_before, k);
    const std::vector<contact::ContactState<dim>> now = form.contact_states(u, k);
    for (std::size_t q = 0; q < n; ++q)
    {
      const std::size_t i = k * n + q;
      if (responses[i].state.damage <= form.contact_points()[i].state.damage) continue;
      change[i] = now[q].slip - before[q].slip - (now[q].gap - before[q].gap) * now[q].normal;
    }
  }
  std::vector<double> c(u.size(), 0.0);
  form.add_contact_load(change, c);
  const fem::LagrangeSpace<dim>& space = form.space();
  const double last = space.dot(c, u) - space.dot(c, u_before);
  if (!(last > 0)) return std::nullopt;
  for (double& value : c) value /= last;
  return PathMeasure<dim>(std::move(c));
}

template <int dim>
bool follow_zone(LoadPath<dim>& path, const Control<dim>& control,
                 const typename LoadPath<dim>::Observer& observer, const StepObserver& newton)
{
  constexpr double most = 2;
  const LoadStep<dim>& last = *path.last();
  const std::optional<PathMeasure<dim>> zone =
      zone_measure<dim>(last.at->discrete.form, last.responses, path.position().before_last.u, last.level.u);
  if (!zone) return false;
  const double grown = control.last_increment;
  const Control<dim> by_zone{.name = "zone",
                             .measure = *zone,
                             .increment = grown > 0 ? std::min(control.increment / grown, most) : 1,
                             .last_increment = 1,
                             .largest_change = control.largest_change,
                             .cuts = control.cuts};
  return path.follow(by_zone, observer, newton).empty();
}

template <int dim>
double moving_share(const LoadStep<dim>& step)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  double moving = 0;
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
  {
    const problem::ContactStatus status = step.responses[i].status;
    const bool moves = status == problem::ContactStatus::open || status == problem::ContactStatus::slip;
    if (moves && problem::cone(form.segments()[i / form.n_segment_points()].contact->law).is_bonded)
      moving += form.contact_points()[i].weight;
  }
  return form.problem().full_circle() * form.space().mesh().ranks().sum(moving) / bonded_measure(form);
}

template std::optional<PathMeasure<2>> zone_measure(const contact::NitscheForm<2>&,
                                                    std::span<const problem::InterfaceResponse<2>>,
                                                    std::span<const double>, std::span<const double>);
template std::optional<PathMeasure<3>> zone_measure(const contact::NitscheForm<3>&,
                                                    std::span<const problem::InterfaceResponse<3>>,
                                                    std::span<const double>, std::span<const double>);
template bool follow_zone(LoadPath<2>&, const Control<2>&, const LoadPath<2>::Observer&, const StepObserver&);
template bool follow_zone(LoadPath<3>&, const Control<3>&, const LoadPath<3>::Observer&, const StepObserver&);
template double moving_share(const LoadStep<2>&);
template double moving_share(const LoadStep<3>&);

}  // namespace tribound::adapt
