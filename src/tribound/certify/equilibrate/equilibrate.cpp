#include "tribound/certify/equilibrate/equilibrate.h"

#include "tribound/certify/equilibrate/mesh_equilibrator.h"
#include "tribound/fem/degree.h"

namespace tribound::certify
{

template <int dim>
Equilibrator<dim>::Equilibrator(const contact::NitscheForm<dim>& form, int n_threads) : form_(form)
{
  form.space().mesh().ranks().together(
      [&]
      {
        fem::with_degree(form.space().degree(),
                         [&](auto p) { implementation_ = make_mesh_equilibrator<dim, p>(form, n_threads); });
      });
}

template <int dim>
Equilibrator<dim>::~Equilibrator() = default;

namespace
{

/// What the parts of the stress of an iterate carry on Gamma_C.
template <int dim>
typename Stress<dim>::Tractions tractions_of(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                             std::span<const Point<dim>> t, double delta)
{
  typename Stress<dim>::Tractions tractions{form.traction(u), {t.begin(), t.end()}, {}};
  auto& [dis, lin, reg] = tractions;
  if (delta > 0) reg = form.traction(u, delta);
  for (std::size_t i = 0; i < lin.size(); ++i) lin[i] -= delta > 0 ? reg[i] : dis[i];
  for (std::size_t i = 0; i < reg.size(); ++i) reg[i] -= dis[i];
  return tractions;
}

}  // namespace

template <int dim>
Stress<dim> Equilibrator<dim>::operator()(std::span<const double> u, std::span<const Point<dim>> t,
                                          double delta)
{
  return form_.space().mesh().ranks().together(
      [&] { return implementation_->run(u, tractions_of(form_, u, t, delta), true, {}); });
}

template <int dim>
Stress<dim> Equilibrator<dim>::linearisation(std::span<const double> u, std::span<const Point<dim>> t)
{
  return form_.space().mesh().ranks().together(
      [&] { return implementation_->run(u, tractions_of(form_, u, t, 0), false, {}); });
}

template <int dim>
Stress<dim> Equilibrator<dim>::balanced(std::span<const double> u, std::span<const Point<dim>> t,
                                        std::span<const Tensor<dim>> turning)
{
  return form_.space().mesh().ranks().together(
      [&] {
        return implementation_->run(u, {{t.begin(), t.end()}, {}, {}}, true, turning);
      });
}

template class Equilibrator<2>;
template class Equilibrator<3>;

}  // namespace tribound::certify
