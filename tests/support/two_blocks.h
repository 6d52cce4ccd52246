#pragma once

/// @file two_blocks.h
/// A block on another one, for tests of contact between bodies.

#include <array>
#include <utility>

#include "support/meshes.h"

namespace tribound::test
{

/// A mesh of (0,2) x (0,1) (x (0,1)) on a block of cells below it, whose names end with "_below".
template <int dim>
mesh::MeshData<dim> on_block(mesh::MeshData<dim> upper, const std::array<int, dim>& cells)
{
  Point<dim> lowest = Point<dim>::Zero();
  Point<dim> highest = Point<dim>::Ones();
  lowest[1] = -1;
  highest[1] = 0;
  highest[0] = 2;
  mesh::MeshData<dim> data = side_by_side(std::move(upper), box<dim>(lowest, highest, cells), "_below");
  data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
  return data;
}

/// A block on another one whose mesh continues its own; names of the lower one end with "_below".
template <int dim>
mesh::MeshData<dim> matching_blocks(int finer = 1)
{
  std::array<int, dim> cells;
  cells.fill(dim == 2 ? 2 : 1);
  cells[0] = dim == 2 ? 4 : 2;
  for (int& n : cells) n *= finer;
  Point<dim> corner = Point<dim>::Ones();
  corner[0] = 2;
  return on_block<dim>(box<dim>(Point<dim>::Zero(), corner, cells), cells);
}

/// Two blocks side by side, (0,1) x (0,1) and (1,2) x (0,1) (x (0,1)), whose names end with "_b", on a third
/// one, as above, all meshes matching.
template <int dim>
mesh::MeshData<dim> three_blocks(int finer = 1)
{
  std::array<int, dim> cells;
  cells.fill(dim == 2 ? 2 * finer : finer);
  Point<dim> corner = Point<dim>::Zero();
  corner[0] = 1;
  const mesh::MeshData<dim> left = box<dim>(Point<dim>::Zero(), Point<dim>::Ones(), cells);
  const mesh::MeshData<dim> right = box<dim>(corner, Point<dim>(corner + Point<dim>::Ones()), cells);
  cells[0] *= 2;
  mesh::MeshData<dim> data = on_block<dim>(side_by_side(left, right, "_b"), cells);
  data.interfaces[0].sides[0].emplace_back("bottom_b");
  data.interfaces.push_back({{{{"right"}, {"left_b"}}}});
  return data;
}

/// The same in three dimensions with another mesh of the third one.
inline mesh::MeshData<3> three_blocks_on_another_mesh()
{
  const mesh::MeshData<3> left = box<3>({0, 0, 0}, {1, 1, 1}, {2, 1, 2});
  const mesh::MeshData<3> right = box<3>({1, 0, 0}, {2, 1, 1}, {2, 1, 2});
  mesh::MeshData<3> data = on_block<3>(side_by_side(left, right, "_b"), {3, 1, 1});
  data.interfaces[0].sides[0].emplace_back("bottom_b");
  data.interfaces.push_back({{{{"right"}, {"left_b"}}}});
  return data;
}

/// Two blocks that touch, on meshes that do not match; names of the lower one end with "_below".
template <int dim>
mesh::MeshData<dim> two_blocks(int finer = 1)
{
  std::array<int, dim> cells;
  cells.fill(dim == 2 ? 2 * finer : finer);
  cells[0] = 3 * finer;
  cells[dim - 1] = 2 * finer;
  return on_block<dim>(block<dim>({4 * finer, 2 * finer}, {2 * finer, finer, finer}), cells);
}

}  // namespace tribound::test
