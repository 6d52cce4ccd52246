#pragma once

/// @file middle_rule.h
/// Shape functions of elements halfway between two of their corners.

#include <utility>
#include <vector>

#include "tribound/mesh/import/element_type.h"

namespace tribound::mesh
{

/// The value at the middle of corners a and b in the coordinates of the element, as a sum of weights times
/// values at its nodes: N_i((xi_a + xi_b) / 2), serendipity functions where centres have no node. The corners
/// lie on an edge, on a quadrilateral face or plane element, or opposite to each other in a hexahedron.
[[nodiscard]] std::vector<std::pair<int, double>> middle_rule(const ElementType& type, int a, int b);

}  // namespace tribound::mesh
