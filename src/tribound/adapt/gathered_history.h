#pragma once

/// @file gathered_history.h
/// The history of contact points of several ranks, for a form on cells gathered on one rank.

#include <memory>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::adapt
{

/// States at the contact points of all ranks, each with its position.
template <int dim>
struct GatheredHistory
{
  struct State
  {
    int tag;  ///< number of the boundary
    Point<dim> x;
    problem::InterfaceState<dim> state;
  };
  std::vector<State> states;  ///< empty except on the first rank, and where there is no history
};

/// All ranks call it together.
template <int dim>
[[nodiscard]] GatheredHistory<dim> gather_history(const contact::NitscheForm<dim>& form);

/// The states as the history of a form whose contact points are among those gathered. Null where there are no
/// states, or the form has other points.
template <int dim>
[[nodiscard]] std::shared_ptr<const contact::ContactHistory<dim>> history_on(
    const contact::NitscheForm<dim>& form, const GatheredHistory<dim>& gathered);

}  // namespace tribound::adapt
