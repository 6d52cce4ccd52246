#pragma once

/// @file page_contact.h
/// Contact on a level as data of the report page: profiles in 2D, faces and segments in 3D, interfaces.

#include <span>

#include "app/page/page_surface.h"
#include "tribound/io/file/json_forward.h"

namespace tribound::app
{

/// Members for the data of a level, whose surface is given: `contact` and `pairs` in 3D, `profiles` in 2D,
/// `interfaces` where bodies touch; those without contents are absent.
template <int dim>
[[nodiscard]] io::Json page_contact(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                    const Surface& surface, const PageLimits& limits);

}  // namespace tribound::app
