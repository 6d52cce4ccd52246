#include <algorithm>
#include <utility>

#include "tribound/problem/problem.h"

namespace tribound::problem
{

template <int dim>
bool BoundaryCondition<dim>::fixes_any() const
{
  return rigid ||
         std::ranges::any_of(displacement, [](const auto& component) { return component.has_value(); });
}

template <int dim>
const Field& BoundaryCondition<dim>::prescribed(int component) const
{
  static const Field zero(0.0);
  return rigid ? zero : *displacement[component];
}

template <int dim>
Tensor<dim> BoundaryCondition<dim>::on_free(Tensor<dim> stiffness) const
{
  for (int a = 0; a < dim; ++a)
    if (fixes(a))
    {
      stiffness.row(a).setZero();
      stiffness.col(a).setZero();
    }
  return stiffness;
}

template <int dim>
Tensor<dim> BoundaryCondition<dim>::clamped() const
{
  Tensor<dim> result = Tensor<dim>::Zero();
  for (int a = 0; a < dim; ++a)
    if (clamps(a)) result(a, a) = 1;
  return result;
}

template <int dim>
Tensor<dim> BoundaryCondition<dim>::held(const Point<dim>& x, const Point<dim>& n) const
{
  if (!spring) return clamped();
  const auto acts = [&](const Field& k) { return k(x) > 0 ? 1.0 : 0.0; };
  return clamped() + on_free(spring_matrix<dim>(acts(spring->normal), acts(spring->tangential), n));
}

template <int dim>
Tensor<dim> BoundaryCondition<dim>::acting(const Point<dim>& n) const
{
  if (!spring) return clamped();
  const auto may_act = [](const Field& k) { return k.is_zero() ? 0.0 : 1.0; };
  return clamped() + on_free(spring_matrix<dim>(may_act(spring->normal), may_act(spring->tangential), n));
}

template <int dim>
bool BoundaryCondition<dim>::is_loaded() const
{
  const bool pressed = pressure && !pressure->is_zero();
  for (int i = 0; i < dim; ++i)
    if (!fixes(i) && (pressed || !traction[i].is_zero())) return true;
  return false;
}

template <int dim>
Point<dim> BoundaryCondition<dim>::load(const Point<dim>& x, const Point<dim>& n) const
{
  const double p = pressure ? (*pressure)(x) : 0.0;
  Point<dim> g;
  for (int i = 0; i < dim; ++i) g[i] = fixes(i) ? 0.0 : traction[i](x) - p * n[i];
  return g;
}

namespace
{

template <int dim>
BoundaryCondition<dim> of_name(const std::string& name)
{
  BoundaryCondition<dim> condition;
  condition.name = name;
  condition.where.key = name;
  return condition;
}

}  // namespace

template <int dim>
BoundaryCondition<dim> with_displacement(const std::string& name,
                                         std::array<std::optional<Field>, dim> displacement)
{
  BoundaryCondition<dim> condition = of_name<dim>(name);
  condition.displacement = std::move(displacement);
  return condition;
}

template <int dim>
BoundaryCondition<dim> with_traction(const std::string& name, std::array<Field, dim> traction)
{
  BoundaryCondition<dim> condition = of_name<dim>(name);
  condition.traction = std::move(traction);
  return condition;
}

template <int dim>
BoundaryCondition<dim> with_contact(const std::string& name, ContactLaw law, Field gap)
{
  BoundaryCondition<dim> condition = of_name<dim>(name);
  condition.contact.emplace(std::move(law), std::move(gap));
  return condition;
}

template struct BoundaryCondition<2>;
template struct BoundaryCondition<3>;
template BoundaryCondition<2> with_displacement<2>(const std::string&, std::array<std::optional<Field>, 2>);
template BoundaryCondition<3> with_displacement<3>(const std::string&, std::array<std::optional<Field>, 3>);
template BoundaryCondition<2> with_traction<2>(const std::string&, std::array<Field, 2>);
template BoundaryCondition<3> with_traction<3>(const std::string&, std::array<Field, 3>);
template BoundaryCondition<2> with_contact<2>(const std::string&, ContactLaw, Field);
template BoundaryCondition<3> with_contact<3>(const std::string&, ContactLaw, Field);

}  // namespace tribound::problem
