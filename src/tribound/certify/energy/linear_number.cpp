#include "tribound/certify/energy/linear_number.h"

#include <utility>

#include "tribound/contact/nitsche/residual.h"

namespace tribound::certify
{

template <int dim>
double LinearNumber<dim>::base(const BoundedState<dim>& state, const QuantityParts<dim>& parts) const
{
  if (weight) return contact_work<dim>(state.form, state.t_h.at_points, weight->at_points);
  if (parts.quantity.kind == problem::QuantityKind::load_work)
    return contact::load_work<dim>(state.form, state.v);
  if (parts.quantity.kind == problem::QuantityKind::spring_force)
    return state.form.springs().force(parts.tag, state.v).dot(parts.direction);
  return mean_displacement<dim>(state.form, parts, state.v);
}

template <int dim>
std::string set_weight(LinearNumber<dim>& number, const contact::NitscheForm<dim>& form,
                       const contact::NitscheForm<dim>& bounded, const ContactWeights<dim>& weights,
                       const ContactResultant<dim>& resultant, double ramp)
{
  ContactWeight<dim> weight = weights(bounded, resultant, ramp);
  if (!weight.reason.empty()) return weight.reason;
  number.phi = &form == &bounded ? weight.at_points : weights(form, resultant, ramp).at_points;
  number.weight = std::move(weight);
  return {};
}

template <int dim>
LinearNumber<dim> loaded_number(const QuantityParts<dim>& parts, const contact::NitscheForm<dim>& bounded)
{
  const mesh::Mesh<dim>& mesh = bounded.space().mesh();
  const problem::Problem<dim>& problem = bounded.problem();
  const auto loaded = [&]
  {
    switch (parts.quantity.kind)
    {
      case problem::QuantityKind::load_work:
        return with_loads<dim>(problem, mesh);
      case problem::QuantityKind::spring_force:
        return with_spring_moved<dim>(problem, mesh, parts.tag, parts.direction);
      default:
        return with_load_on<dim>(problem, mesh, parts.tag, parts.direction / parts.measure);
    }
  };
  return {.loads = std::make_unique<DualProblem<dim>>(bounded, loaded())};
}

template struct LinearNumber<2>;
template struct LinearNumber<3>;
template std::string set_weight(LinearNumber<2>&, const contact::NitscheForm<2>&,
                                const contact::NitscheForm<2>&, const ContactWeights<2>&,
                                const ContactResultant<2>&, double);
template std::string set_weight(LinearNumber<3>&, const contact::NitscheForm<3>&,
                                const contact::NitscheForm<3>&, const ContactWeights<3>&,
                                const ContactResultant<3>&, double);
template LinearNumber<2> loaded_number(const QuantityParts<2>&, const contact::NitscheForm<2>&);
template LinearNumber<3> loaded_number(const QuantityParts<3>&, const contact::NitscheForm<3>&);

}  // namespace tribound::certify
