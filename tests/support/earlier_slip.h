#pragma once

/// @file earlier_slip.h
/// Contact that has slipped in earlier load steps.

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "tribound/adapt/contact_functions.h"
#include "tribound/contact/nitsche/form_history.h"

namespace tribound::test
{

/// Lets contact points remember the tangential part of w(x, number of the segment).
template <int dim, class Slip>
void set_earlier_slip(contact::NitscheForm<dim>& form, const Slip& w)
{
  std::vector<problem::InterfaceState<dim>> states;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    for (const contact::ContactPoint<dim>& point : form.contact_points(k))
    {
      states.push_back(point.state);
      const Point<dim> slip = w(point.x, k);
      states.back().slip = slip - slip.dot(point.normal) * point.normal;
    }
  form.set_history(std::make_shared<const contact::ContactHistory<dim>>(std::move(states), form.facet_rule(),
                                                                        form.space().degree() + 2));
}

/// A random slip: quadratic in x or, if segments of finer meshes are parts of those here, also with kinks, or
/// with jumps between segments.
template <int dim>
void set_random_slip(contact::NitscheForm<dim>& form, unsigned seed, bool nests)
{
  std::mt19937 random(seed + 1000);
  const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const unsigned kind = random() % (nests ? 4 : 2);
  const double size = std::pow(10.0, -2 + number());
  Point<dim> constant;
  Point<dim> linear;
  Point<dim> quadratic;
  for (int a = 0; a < dim; ++a)
  {
    constant[a] = size * number();
    linear[a] = size * number();
    quadratic[a] = size * number();
  }
  std::vector<double> factors;
  for (std::size_t k = 0; k < form.segments().size(); ++k) factors.push_back(kind == 3 ? number() : 1);
  set_earlier_slip<dim>(form,
                        [&](const Point<dim>& x, std::size_t k) -> Point<dim>
                        {
                          const double s = x[0] + 0.3 * x[dim - 1];
                          const Point<dim> w = constant + linear * s + (kind > 0) * s * s * quadratic;
                          return kind == 2 && s < 0.9 ? Point<dim>(Point<dim>::Zero())
                                                      : Point<dim>(factors[k] * w);
                        });
}

/// Lets a form on a refinement, of the same or a higher degree, remember what `from` does.
template <int dim>
void remember_as(const contact::NitscheForm<dim>& from, contact::NitscheForm<dim>& to)
{
  const fem::LagrangeSpace<dim> space(to.space().mesh(), from.space().degree());
  contact::NitscheForm<dim> between(to.problem(), space, from.gamma0());
  between.set_history(adapt::carried_history<dim>(*from.history(), from, between));
  to.set_history(contact::raised_history<dim>(between, to));
}

}  // namespace tribound::test
