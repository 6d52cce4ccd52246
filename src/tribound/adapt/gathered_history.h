#pragma once

/// @file gathered_history.h
/// What the contact points of several ranks remember, for a form on cells that are put together on one.

#include <memory>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::adapt
{

/// States at the contact points of all ranks, each with where it is.
template <int dim>
struct GatheredHistory
{
  struct State
  {
    int tag;  ///< number of the boundary
    Point<dim> x;
    problem::InterfaceState<dim> state;
  };
  std::vector<State> states;  ///< empty elsewhere than on the first rank, and where nothing is remembered
};

/// All ranks call it together.
template <int dim>
[[nodiscard]] GatheredHistory<dim> gather_history(const contact::NitscheForm<dim>& form);

/// The states as the history of a form whose contact points are some of those; null where there are none, or
/// the form has others.
template <int dim>
[[nodiscard]] std::shared_ptr<const contact::ContactHistory<dim>> history_on(
    const contact::NitscheForm<dim>& form, const GatheredHistory<dim>& gathered);

}  // namespace tribound::adapt
