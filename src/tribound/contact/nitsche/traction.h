#pragma once

/// @file traction.h
/// What a contact law answers to, method section 2.

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/problem/material.h"

namespace tribound::contact
{

/// P = sigma n - gamma (u - g n), so that P^n = P.n and P^t = P - P^n n.
template <int dim>
[[nodiscard]] Point<dim> augmented_traction(const problem::Material& material, double gamma, double gap,
                                            const Point<dim>& n, const Point<dim>& u,
                                            const Tensor<dim>& gradient)
{
  return sigma<dim>(material, gradient) * n - gamma * (u - gap * n);
}

}  // namespace tribound::contact
