#pragma once

/// @file data_effect.h
/// How large a stress the data of a problem can cause, estimated from their size.

#include <span>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// The sum of the effects of loads, prescribed displacements, interferences (g < 0 at the `points` of the
/// segments) and water in the norm of the stress: stress times length^(dim/2). `volume`: of the body. All
/// ranks together.
template <int dim>
[[nodiscard]] double largest_effect(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                    std::span<const ContactSegment<dim>> segments,
                                    std::span<const Point<dim - 1>> points, double volume);

}  // namespace tribound::contact
