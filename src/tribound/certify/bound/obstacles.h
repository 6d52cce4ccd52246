#pragma once

/// @file obstacles.h
/// What is known for rigid obstacles only refuses everything else.

#include <algorithm>
#include <string>

#include "tribound/base/error.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Throws InputError unless every contact segment is a whole facet against a rigid obstacle; `what` is known
/// for these only.
template <int dim>
void require_obstacles(const contact::NitscheForm<dim>& form, const std::string& what)
{
  if (!std::ranges::all_of(form.segments(), &contact::ContactSegment<dim>::is_obstacle_facet))
    throw InputError({}, what + " is not known for contact on parts of facets or between bodies",
                     "take contact with rigid obstacles, on whole facets");
}

}  // namespace tribound::certify
