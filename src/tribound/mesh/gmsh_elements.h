#pragma once

/// @file gmsh_elements.h
/// Which elements the model that Gmsh has loaded consists of.

#include <array>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// Gmsh's numbers of first-order simplices, by dimension.
inline constexpr std::array<int, 4> simplex_type = {15, 1, 2, 4};

/// 3 if there are solids of any shape, else 2. Throws InputError where there are no surfaces either.
[[nodiscard]] int mesh_dimension(const Where& where);

/// Throws InputError where cells or their facets are not straight-sided simplices.
void check_element_types(const Where& where, int mesh_dim);

}  // namespace tribound::mesh
