#pragma once

/// @file vtk_cell_type.h
/// The cells of VTK.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "tribound/mesh/import/element_type.h"

namespace tribound::mesh
{

struct VtkCellType
{
  std::int64_t number;  ///< as in vtkCellType.h
  ElementType type;
  std::span<const int> order;  ///< for each node of ElementType its place among those of VTK; empty: the same
};

/// The type of a cell; nullptr if it is not read. Old hexahedra of order 2 have the last two edges the other
/// way round.
[[nodiscard]] const VtkCellType* find_vtk_type(std::int64_t number, std::size_t n_nodes,
                                               bool has_old_hexahedra);

/// "polyhedron", "Lagrange hexahedron"; "unknown cell".
[[nodiscard]] std::string vtk_type_name(std::int64_t number);

}  // namespace tribound::mesh
