#pragma once

/// @file softening.h
/// What the mesh size has to be where an interface softens (method section 12.1).

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// Where gamma comes nearest to the slope with which a law softens.
struct SofteningMargin
{
  double ratio = 0;         ///< slope / gamma: below 1 the resolvent is unique; 0 where nothing softens
  std::size_t segment = 0;  ///< number of the segment, on this process
};

template <int dim>
[[nodiscard]] SofteningMargin softening_margin(const NitscheForm<dim>& form);

/// Throws InputError where slope >= gamma, naming the facet, both, and the facet size that would do. All
/// ranks together.
template <int dim>
void check_softening(const NitscheForm<dim>& form);

}  // namespace tribound::contact
