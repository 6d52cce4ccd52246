#include "tribound/contact/nitsche/form_history.h"

#include <utility>

namespace tribound::contact
{

template <int dim>
std::shared_ptr<const ContactHistory<dim>> history_from_values(
    const NitscheForm<dim>& form, std::vector<problem::InterfaceState<dim>> values)
{
  const auto cut = [&](std::size_t point, problem::InterfaceState<dim> state)
  {
    const Point<dim>& n = form.contact_points()[point].normal;
    state = problem::admissible<dim>(form.segments()[point / form.n_segment_points()].contact->law, state);
    state.slip -= state.slip.dot(n) * n;
    return state;
  };
  return std::make_shared<const ContactHistory<dim>>(std::move(values), form.facet_rule(),
                                                     form.space().degree() + 2, cut);
}

template <int dim>
std::shared_ptr<const ContactHistory<dim>> raised_history(const NitscheForm<dim>& from,
                                                          const NitscheForm<dim>& to)
{
  std::vector<problem::InterfaceState<dim>> values;
  values.reserve(to.n_contact_points());
  for (std::size_t k = 0; k < to.segments().size(); ++k)
    for (const Point<dim - 1>& s : to.facet_rule().points) values.push_back(from.history()->uncut(k, s));
  return history_from_values<dim>(to, std::move(values));
}

template std::shared_ptr<const ContactHistory<2>> history_from_values(
    const NitscheForm<2>&, std::vector<problem::InterfaceState<2>>);
template std::shared_ptr<const ContactHistory<3>> history_from_values(
    const NitscheForm<3>&, std::vector<problem::InterfaceState<3>>);
template std::shared_ptr<const ContactHistory<2>> raised_history(const NitscheForm<2>&,
                                                                 const NitscheForm<2>&);
template std::shared_ptr<const ContactHistory<3>> raised_history(const NitscheForm<3>&,
                                                                 const NitscheForm<3>&);

}  // namespace tribound::contact
