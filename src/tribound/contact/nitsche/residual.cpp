#include "tribound/contact/nitsche/residual.h"

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/springs.h"

namespace tribound::contact
{

template <int dim>
std::vector<double> unconstrained_residual(const NitscheForm<dim>& form, std::span<const double> u,
                                           std::span<const Point<dim>> t)
{
  std::vector<double> r = apply_stiffness(form.problem(), form.space(), u);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = form.load()[i] - r[i];
  form.add_contact_load(t, r);
  return r;
}

template <int dim>
std::vector<double> residual(const NitscheForm<dim>& form, std::span<const double> u,
                             std::span<const Point<dim>> t)
{
  std::vector<double> r = unconstrained_residual(form, u, t);
  for (std::size_t i = 0; i < r.size(); ++i)
    if (form.constraints().fixed[i]) r[i] = 0;
  return r;
}

template <int dim>
double load_work(const NitscheForm<dim>& form, std::span<const double> u)
{
  std::vector<double> of_springs(u.size(), 0.0);
  Springs<dim>(form.problem(), form.space()).add_rest(of_springs);
  return form.space().dot(form.load(), u) - form.space().dot(of_springs, u);
}

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
