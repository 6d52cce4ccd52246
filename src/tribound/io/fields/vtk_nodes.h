#pragma once

/// @file vtk_nodes.h
/// The node order of VTK's Lagrange simplices.

#include <array>
#include <cstdint>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/lagrange.h"

namespace tribound::io
{

/// VTK's cell type of the Lagrange k-simplex: curve, triangle, tetrahedron.
template <int k>
inline constexpr std::uint8_t vtk_lagrange_type = k == 1   ? 68
                                                  : k == 2 ? 69
                                                           : 71;

/// Barycentric coordinates times p of the nodes of VTK's Lagrange k-simplex, k = 1, 2, 3, in VTK's order:
/// vertices, inner nodes of the edges, of the faces, of the cell.
template <int k>
[[nodiscard]] std::vector<std::array<int, k + 1>> vtk_nodes(int degree);

/// Their reference coordinates.
template <int k>
[[nodiscard]] std::vector<Point<k>> vtk_points(int degree);

/// For every node in VTK's order, its index in `basis`.
template <int k>
[[nodiscard]] std::vector<int> vtk_order(const fem::LagrangeBasis<k>& basis);

}  // namespace tribound::io
