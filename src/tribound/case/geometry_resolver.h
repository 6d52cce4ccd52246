#pragma once

/// @file geometry_resolver.h
/// Gap and direction of a contact from obstacles and shapes.

#include "tribound/case/config.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// Sets what `geometry` says of a contact with a rigid obstacle, or with a master. Throws InputError for
/// surfaces of another dimension.
template <int dim>
void apply_geometry(const Config& config, const GeometryConfig& geometry, problem::Contact& contact);

}  // namespace tribound::case_file
