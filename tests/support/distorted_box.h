#pragma once

/// @file distorted_box.h
/// A body of general cells, without loads and supports.

#include <utility>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

template <int dim>
[[nodiscard]] DiscreteProblem<dim> distorted_box(int degree)
{
  mesh::MeshData<dim> data;
  if constexpr (dim == 2)
    data = block<2>({3, 2});
  else
    data = box<3>({0, 0, 0}, {1, 1, 1}, {1, 2, 1});
  return {distorted(std::move(data), 4), {.material = lame(1.3, 0.3)}, {.degree = degree}};
}

}  // namespace tribound::test
