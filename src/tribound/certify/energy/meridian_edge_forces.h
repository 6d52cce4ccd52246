#pragma once

/// @file meridian_edge_forces.h
/// What a solution of degree 1 of an axisymmetric problem leaves on the edges: the forces of edge_moments().

#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// Per edge of the topology R(psi_a psi_b e_i) with the weight r, R the residual of u with the contact
/// traction t; 0 in the components that Gamma_D fixes on the edge, and in the radial one on the axis.
[[nodiscard]] std::vector<Point<2>> meridian_edge_forces(const contact::NitscheForm<2>& form,
                                                         std::span<const double> u,
                                                         std::span<const Point<2>> t);

}  // namespace tribound::certify
