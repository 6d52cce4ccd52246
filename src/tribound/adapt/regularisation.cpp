#include "tribound/adapt/regularisation.h"

#include <array>
#include <cmath>

namespace tribound::adapt
{

bool regularisation_is_negligible(const certify::BoundComponents& eta, double gamma_reg)
{
  return eta.regularisation() <= gamma_reg * eta.discretisation();
}

template <int dim>
double mean_contact_traction(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t)
{
  std::array<double, 2> sums{};
  auto& [square, measure] = sums;
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
  {
    const double weight = form.contact_points()[i].weight;
    square += weight * t[i].squaredNorm();
    measure += weight;
  }
  form.space().mesh().ranks().sum(std::span(sums));
  return measure > 0 ? std::sqrt(square / measure) : 0;
}

template <int dim>
solve::NewtonAdvice DeltaUpdates::advise(const contact::NitscheForm<dim>& form,
                                         const solve::NewtonIterate<dim>& iterate,
                                         const certify::BoundComponents& eta, bool inner_done)
{
  solve::NewtonAdvice advice = inner_done;
  if (delta == 0)
  {
    delta = config.delta * mean_contact_traction<dim>(form, iterate.traction);
    if (!inner_done && delta > 0) advice.delta = delta;
  }
  else if (inner_done && n_updates < config.max_updates &&
           !regularisation_is_negligible(eta, config.gamma_reg))
  {
    delta *= config.factor;
    ++n_updates;
    advice.delta = delta;
    advice.good_enough = false;
  }
  return advice;
}

template double mean_contact_traction(const contact::NitscheForm<2>&, std::span<const Point<2>>);
template double mean_contact_traction(const contact::NitscheForm<3>&, std::span<const Point<3>>);
template solve::NewtonAdvice DeltaUpdates::advise(const contact::NitscheForm<2>&,
                                                  const solve::NewtonIterate<2>&,
                                                  const certify::BoundComponents&, bool);
template solve::NewtonAdvice DeltaUpdates::advise(const contact::NitscheForm<3>&,
                                                  const solve::NewtonIterate<3>&,
                                                  const certify::BoundComponents&, bool);

}  // namespace tribound::adapt
