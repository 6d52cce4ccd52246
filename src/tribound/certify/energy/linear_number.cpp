#include "tribound/certify/energy/linear_number.h"

namespace tribound::certify
{

template <int dim>
std::string LinearNumber<dim>::make_pair(const contact::NitscheForm<dim>& form, DualSystems<dim>& systems)
{
  constexpr double near = 1e-8;  // any z will do
  constexpr double tight = 1e-12;
  const std::vector<double> none(form.space().n_dofs(), 0.0);
  if (weight)
  {
    std::vector<double> start = weight->at_nodes;
    for (double& value : start) value = -value;
    pair.z = systems.with_held_contact().solve(none, start, near);
    return {};
  }
  std::string reason;
  const std::vector<double> b = loads->load(on_contact);
  pair.z = systems.with_held_contact().solve(b, none, near);
  pair.target = systems.with_free_contact().solve(b, none, tight);
  pair.stress = loads->balanced(pair.target, on_contact, reason);
  return reason;
}

template <int dim>
double LinearNumber<dim>::base(const BoundedState<dim>& state, const QuantityParts<dim>& parts) const
{
  if (weight) return contact_work<dim>(state.form, state.t_h.at_points, weight->at_points);
  if (parts.quantity.kind == problem::QuantityKind::load_work)
    return state.form.space().dot(state.form.load(), state.v);
  return mean_displacement<dim>(state.form, parts, state.v);
}

template <int dim>
void set_weight(LinearNumber<dim>& number, const contact::NitscheForm<dim>& form,
                const contact::NitscheForm<dim>& bounded, const ContactResultant<dim>& resultant, double ramp)
{
  number.weight = contact_weight(bounded, resultant, ramp);
  number.phi = &form == &bounded ? number.weight->at_points : contact_weight(form, resultant, ramp).at_points;
}

template <int dim>
LinearNumber<dim> loaded_number(const QuantityParts<dim>& parts, const contact::NitscheForm<dim>& bounded)
{
  const mesh::Mesh<dim>& mesh = bounded.space().mesh();
  const problem::Problem<dim>& problem = bounded.problem();
  LinearNumber<dim> number;
  number.on_contact.assign(bounded.n_contact_points(), Point<dim>::Zero());
  if (parts.quantity.kind == problem::QuantityKind::load_work)
  {
    number.loads = std::make_unique<DualProblem<dim>>(bounded, with_loads<dim>(problem, mesh));
    return number;
  }
  const Point<dim> q = parts.direction / parts.measure;
  const bool is_contact = problem.contact(parts.tag) != nullptr;
  number.loads = std::make_unique<DualProblem<dim>>(
      bounded, with_load_on<dim>(problem, mesh, is_contact ? -1 : parts.tag, q));
  for (std::size_t i = 0; i < number.on_contact.size(); ++i)
    if (bounded.segments()[i / bounded.n_segment_points()].slave.facet.tag == parts.tag)
      number.on_contact[i] = q;
  return number;
}

template struct LinearNumber<2>;
template struct LinearNumber<3>;
template void set_weight(LinearNumber<2>&, const contact::NitscheForm<2>&, const contact::NitscheForm<2>&,
                         const ContactResultant<2>&, double);
template void set_weight(LinearNumber<3>&, const contact::NitscheForm<3>&, const contact::NitscheForm<3>&,
                         const ContactResultant<3>&, double);
template LinearNumber<2> loaded_number(const QuantityParts<2>&, const contact::NitscheForm<2>&);
template LinearNumber<3> loaded_number(const QuantityParts<3>&, const contact::NitscheForm<3>&);

}  // namespace tribound::certify
