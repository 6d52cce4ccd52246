#pragma once

/// @file gmsh_elements.h
/// The elements of the model that Gmsh has loaded.

#include <array>

#include "tribound/base/error.h"

namespace tribound::mesh
{

/// Gmsh's numbers of simplices, [order - 1][dimension].
inline constexpr std::array<std::array<int, 4>, 2> simplex_type = {{{15, 1, 2, 4}, {15, 8, 9, 11}}};

/// 3 if there are solids of any shape, else 2. Throws InputError where there are no surfaces either.
[[nodiscard]] int mesh_dimension(const Where& where);

/// The order of the cells and of their facets, 1 or 2. Throws InputError if they are no simplices, of
/// different orders, or of higher order.
[[nodiscard]] int mesh_order(const Where& where, int mesh_dim);

}  // namespace tribound::mesh
