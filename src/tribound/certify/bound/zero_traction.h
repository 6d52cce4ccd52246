#pragma once

/// @file zero_traction.h
/// Where contact exerts no traction on a body at rest.

#include <cstddef>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Whether T(0) = 0 on all of segment k for any threshold: the gap is proved to be nonnegative, there is
/// neither water nor a bond, and nothing has slipped.
template <int dim>
[[nodiscard]] bool has_no_traction_at_rest(const contact::NitscheForm<dim>& form, std::size_t k);

}  // namespace tribound::certify
