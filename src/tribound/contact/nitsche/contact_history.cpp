#include "tribound/contact/nitsche/contact_history.h"

#include <array>
#include <cassert>
#include <utility>

#include "tribound/fem/degree.h"
#include "tribound/fem/polynomials.h"

namespace tribound::contact
{

template <int dim>
ContactHistory<dim>::ContactHistory(std::vector<problem::InterfaceState<dim>> states,
                                    const fem::Quadrature<dim - 1>& rule, int degree)
    : states_(std::move(states)),
      degree_(degree),
      n_(fem::polynomial_dimension(dim - 1, degree)),
      coefficients_(states_.size() / rule.size() * n_, Values::Zero())
{
  const std::size_t n_points = rule.size();
  assert(states_.size() % n_points == 0);
  std::vector<double> theta(n_);
  for (std::size_t q = 0; q < n_points; ++q)
  {
    fem::orthonormal_values<dim - 1>(degree, rule.points[q], theta);
    for (std::size_t k = 0; k < states_.size() / n_points; ++k)
    {
      const problem::InterfaceState<dim>& state = states_[k * n_points + q];
      Values values;
      values << state.damage, state.slipped, state.slip;
      for (std::size_t i = 0; i < n_; ++i) coefficients_[k * n_ + i] += rule.weights[q] * theta[i] * values;
    }
  }
}

template <int dim>
ContactHistory<dim>::ContactHistory(std::vector<problem::InterfaceState<dim>> values,
                                    const fem::Quadrature<dim - 1>& rule, int degree, const Cut& cut)
    : ContactHistory(std::move(values), rule, degree)
{
  for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = cut(i, states_[i]);
}

template <int dim>
problem::InterfaceState<dim> ContactHistory<dim>::at(const problem::ContactLaw& law, std::size_t k,
                                                     const Point<dim - 1>& s) const
{
  return problem::admissible<dim>(law, uncut(k, s));
}

template <int dim>
problem::InterfaceState<dim> ContactHistory<dim>::uncut(std::size_t k, const Point<dim - 1>& s) const
{
  std::array<double, fem::polynomial_dimension(dim - 1, fem::max_degree + 2)> theta;
  fem::orthonormal_values<dim - 1>(degree_, s, std::span(theta).first(n_));
  Values values = Values::Zero();
  for (std::size_t i = 0; i < n_; ++i) values += theta[i] * coefficients_[k * n_ + i];
  return {values[0], values[1], values.template tail<dim>()};
}

template class ContactHistory<2>;
template class ContactHistory<3>;

}  // namespace tribound::contact
