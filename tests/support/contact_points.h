#pragma once

/// @file contact_points.h
/// The contact points of a discrete problem as tests look at them.

#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::test
{

/// The states at the contact points.
template <int dim>
[[nodiscard]] std::vector<contact::ContactState<dim>> contact_states(const contact::NitscheForm<dim>& form,
                                                                     std::span<const double> u)
{
  std::vector<contact::ContactState<dim>> states;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : form.contact_states(u, k)) states.push_back(state);
  return states;
}

}  // namespace tribound::test
