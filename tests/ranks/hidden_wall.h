#pragma once

/// @file hidden_wall.h
/// Three bodies, one of which hides part of another.

#include <array>
#include <utility>

#include "support/meshes.h"
#include "support/problem_data.h"

namespace tribound::test
{

/// A block above a plate, and a wall behind the plate, which hides part of the wall.
template <int dim>
[[nodiscard]] std::pair<mesh::MeshData<dim>, ProblemData<dim>> hidden_wall()
{
  const auto corner = [](double x, double y, double z)
  {
    Point<dim> point;
    for (int i = 0; i < dim; ++i) point[i] = std::array{x, y, z}[i];
    return point;
  };
  const auto cells = [](int n, int m)
  {
    std::array<int, dim> result;
    result.fill(n);
    result[1] = m;
    return result;
  };
  mesh::MeshData<dim> data = box<dim>(corner(0, 0, 0), corner(2, 1, 1), cells(4, 1));
  data = side_by_side(std::move(data), box<dim>(corner(0.3, -0.6, 0.1), corner(1.2, -0.2, 0.7), cells(3, 1)),
                      "_plate");
  data = side_by_side(std::move(data), box<dim>(corner(0, -2, 0), corner(2, -1, 1), cells(5, 2)), "_wall");
  ProblemData<dim> problem{.boundaries = {clamped<dim>("bottom_wall"), clamped<dim>("bottom_plate"),
                                          clamped<dim>("left"), loaded<dim>("top", 0.03, -0.1)}};
  problem.pairs.push_back(pair<dim>("bottom", "top_plate", Coulomb(0.3)));
  problem.pairs.back().master.emplace_back("top_wall");
  problem.pairs.back().contact.gap = problem::Field(0.0);
  return {std::move(data), std::move(problem)};
}

}  // namespace tribound::test
