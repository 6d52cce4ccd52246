#include "tribound/certify/equilibrate/equilibrate.h"

#include "tribound/certify/equilibrate/mesh_equilibrator.h"
#include "tribound/fem/degree.h"

namespace tribound::certify
{

template <int dim>
Equilibrator<dim>::Equilibrator(const contact::NitscheForm<dim>& form, int n_threads)
    : ranks_(form.space().mesh().ranks())
{
  ranks_.together(
      [&]
      {
        fem::with_degree(form.space().degree(),
                         [&](auto p) { implementation_ = make_mesh_equilibrator<dim, p>(form, n_threads); });
      });
}

template <int dim>
Equilibrator<dim>::~Equilibrator() = default;

template <int dim>
Stress<dim> Equilibrator<dim>::operator()(std::span<const double> u, std::span<const Point<dim>> t,
                                          double delta)
{
  return ranks_.together([&] { return implementation_->run(u, t, delta, true); });
}

template <int dim>
Stress<dim> Equilibrator<dim>::linearisation(std::span<const double> u, std::span<const Point<dim>> t)
{
  return ranks_.together([&] { return implementation_->run(u, t, 0, false); });
}

template class Equilibrator<2>;
template class Equilibrator<3>;

}  // namespace tribound::certify
