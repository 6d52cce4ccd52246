#pragma once

/// @file two_blocks.h
/// A block on another one, for tests of contact between bodies.

#include <array>

#include "support/meshes.h"

namespace tribound::test
{

/// Two blocks that touch, on meshes that do not match; names of the lower one end with "_below".
template <int dim>
mesh::MeshData<dim> two_blocks()
{
  Point<dim> lower = Point<dim>::Zero();
  Point<dim> upper = Point<dim>::Ones();
  lower[1] = -1;
  upper[1] = 0;
  upper[0] = 2;
  std::array<int, dim> lower_cells;
  lower_cells.fill(dim == 2 ? 2 : 1);
  lower_cells[0] = 3;
  lower_cells[dim - 1] = 2;
  mesh::MeshData<dim> data =
      side_by_side(block<dim>({4, 2}, {2, 1, 1}), box<dim>(lower, upper, lower_cells), "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  return data;
}

}  // namespace tribound::test
