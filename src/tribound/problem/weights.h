#pragma once

/// @file weights.h
/// The weight of integrals on simplices: r on the meridian of bodies of revolution, else 1.

#include <algorithm>
#include <array>

#include "tribound/problem/problem.h"

namespace tribound::problem
{

/// The largest on the simplex with these vertices.
template <int dim, std::size_t n>
[[nodiscard]] double largest_weight(const Problem<dim>& problem, const std::array<Point<dim>, n>& vertices)
{
  double largest = 0;
  for (const Point<dim>& x : vertices) largest = std::max(largest, problem.weight(x));
  return largest;
}

/// Its mean: the integral of the weight is the measure times this.
template <int dim, std::size_t n>
[[nodiscard]] double mean_weight(const Problem<dim>& problem, const std::array<Point<dim>, n>& vertices)
{
  double sum = 0;
  for (const Point<dim>& x : vertices) sum += problem.weight(x);
  return sum / static_cast<double>(n);
}

}  // namespace tribound::problem
