#include "tribound/problem/quantity.h"

#include <fmt/format.h>

namespace tribound::problem
{

namespace
{

bool has_coefficient(const Contact* contact)
{
  return contact != nullptr && cone(contact->law).coefficient > 0;
}

}  // namespace

template <int dim>
int boundary_number(const Quantity<dim>& quantity, const Problem<dim>& problem,
                    std::span<const std::string> boundary_names)
{
  const bool is_safety = quantity.kind == QuantityKind::safety_factor;
  const bool is_of_contact =
      quantity.kind == QuantityKind::contact_force || quantity.kind == QuantityKind::contact_moment;
  const bool is_of_spring = quantity.kind == QuantityKind::spring_force;
  const bool may_be_all = !is_safety && !is_of_spring && quantity.kind != QuantityKind::mean_displacement;
  if (is_of_contact && !problem.has_contact())
    throw InputError(quantity.where, "nothing touches anything", "forces are those of contact boundaries");
  if (quantity.kind == QuantityKind::contact_moment && problem.is_axisymmetric())
    throw InputError(quantity.where, "the moments on bodies of revolution cancel around the axis",
                     "kind = \"contact_force\"");
  if (quantity.boundary.empty() && may_be_all) return -1;
  const int tag = group_number(quantity.boundary, boundary_names, quantity.where, "boundary");
  if (is_of_contact && problem.contact(tag) == nullptr)
    throw InputError(
        quantity.where, fmt::format("boundary \"{}\" touches nothing", quantity.boundary),
        "there is no contact on it: name a boundary with contact, of a pair the slave, or none for all "
        "of them together");
  if (is_safety && !has_coefficient(problem.contact(tag)))
    throw InputError(
        quantity.where, fmt::format("boundary \"{}\" has no Coulomb friction", quantity.boundary),
        "a boundary with contact or an interface that has a coefficient: a safety factor is mu_F N / H");
  if (is_of_spring && !problem.boundary(tag).spring)
    throw InputError(quantity.where, fmt::format("boundary \"{}\" has no spring", quantity.boundary),
                     "a boundary with the key spring");
  return tag;
}

template int boundary_number(const Quantity<2>&, const Problem<2>&, std::span<const std::string>);
template int boundary_number(const Quantity<3>&, const Problem<3>&, std::span<const std::string>);

}  // namespace tribound::problem
