#pragma once

/// @file zero_traction.h
/// Where contact does nothing to a body at rest.

#include <cstddef>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Whether T(0) = 0 on all of segment k, whatever the threshold: the gap is enclosed from below by 0, there
/// is neither water nor a bond, and nothing has slipped.
template <int dim>
[[nodiscard]] bool has_no_traction_at_rest(const contact::NitscheForm<dim>& form, std::size_t k);

}  // namespace tribound::certify
