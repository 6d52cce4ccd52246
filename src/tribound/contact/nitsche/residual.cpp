#include "tribound/contact/nitsche/residual.h"

#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::contact
{

template <int dim>
std::vector<double> internal_forces(const NitscheForm<dim>& form, std::span<const double> u)
{
  std::vector<double> result = apply_stiffness(form.problem(), form.space(), u, form.meridian());
  form.springs().add_forces(u, result);
  return result;
}

template <int dim>
std::vector<double> unconstrained_residual(const NitscheForm<dim>& form, std::span<const double> u,
                                           std::span<const Point<dim>> t)
{
  std::vector<double> r = internal_forces(form, u);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = form.load()[i] - r[i];
  form.add_contact_load(t, r);
  return r;
}

template <int dim>
std::vector<double> residual(const NitscheForm<dim>& form, std::span<const double> u,
                             std::span<const Point<dim>> t)
{
  std::vector<double> r = unconstrained_residual(form, u, t);
  form.keep_free(r);
  return r;
}

template <int dim>
double load_work(const NitscheForm<dim>& form, std::span<const double> u)
{
  std::vector<double> others(u.size(), 0.0);
  form.springs().add_rest(others);
  add_initial_stress<dim>(form.data(), form.space(), others, form.meridian());
  return form.space().dot(form.load(), u) - form.space().dot(others, u);
}

template <int dim>
LoadRemainder traction_remainder(const NitscheForm<dim>& form, std::size_t number, std::span<const double> u)
{
  const LoadRemainder result = form.data().traction_remainder(number);
  const SpringFacet<dim>* facet = form.springs().on(number);
  if (facet == nullptr) return result;
  const LoadRemainder of_spring = form.springs().remainder(*facet, u);
  return {result.oscillation + of_spring.oscillation, result.mean + of_spring.mean};
}

template std::vector<double> internal_forces(const NitscheForm<2>&, std::span<const double>);
template std::vector<double> internal_forces(const NitscheForm<3>&, std::span<const double>);
template LoadRemainder traction_remainder(const NitscheForm<2>&, std::size_t, std::span<const double>);
template LoadRemainder traction_remainder(const NitscheForm<3>&, std::size_t, std::span<const double>);
template double load_work(const NitscheForm<2>&, std::span<const double>);
template double load_work(const NitscheForm<3>&, std::span<const double>);
template std::vector<double> unconstrained_residual(const NitscheForm<2>&, std::span<const double>,
                                                    std::span<const Point<2>>);
template std::vector<double> residual(const NitscheForm<2>&, std::span<const double>,
                                      std::span<const Point<2>>);
template std::vector<double> unconstrained_residual(const NitscheForm<3>&, std::span<const double>,
                                                    std::span<const Point<3>>);
template std::vector<double> residual(const NitscheForm<3>&, std::span<const double>,
                                      std::span<const Point<3>>);

}  // namespace tribound::contact
