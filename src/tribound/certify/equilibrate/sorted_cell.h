#pragma once

/// @file sorted_cell.h
/// A cell seen with its vertices in ascending global order. Two cells that share a facet then run through its
/// vertices in the same order, so that polynomials on the facet need no reorientation.

#include <algorithm>
#include <array>

#include "tribound/base/types.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

template <int dim>
struct SortedCell
{
  mesh::Cell<dim> vertices;               ///< ascending
  std::array<int, dim + 1> local;         ///< local[i]: position of vertices[i] in Mesh::cell
  Point<dim> origin;                      ///< of vertices[0]
  Tensor<dim> jacobian;                   ///< x = origin + J xhat
  Tensor<dim> inverse;                    ///< J^{-1}
  double det;                             ///< |det J| = dim! |T|
  std::array<Point<dim>, dim + 1> grad;   ///< of the barycentric coordinates; facet i has normal -grad/|grad|
  std::array<double, dim + 1> grad_norm;  ///< |grad lambda_i| = |F_i| (dim-1)! / det

  /// Position of vertex `v` in `vertices`.
  [[nodiscard]] int find(Index v) const
  {
    return static_cast<int>(std::ranges::find(vertices, v) - vertices.begin());
  }
  /// Outward unit normal of the facet opposite to vertex i.
  [[nodiscard]] Point<dim> normal(int i) const { return -grad[i] / grad_norm[i]; }
  /// |F_i| / |reference facet|.
  [[nodiscard]] double facet_scale(int i) const { return det * grad_norm[i]; }
};

/// Lexicographic rank of a permutation, such as SortedCell::local.
template <std::size_t n>
[[nodiscard]] int permutation_number(const std::array<int, n>& permutation)
{
  int number = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    int smaller = 0;  // entries to the right that are smaller
    for (std::size_t j = i + 1; j < n; ++j) smaller += permutation[j] < permutation[i];
    number = number * static_cast<int>(n - i) + smaller;
  }
  return number;
}

/// A point in the coordinates of the sorted cell, whose vertices are local[0], local[1], ... of Mesh::cell;
/// given in the reference coordinates of Mesh::cell.
template <int dim>
[[nodiscard]] Point<dim> to_sorted_cell(const std::array<int, dim + 1>& local, const Point<dim>& in_cell)
{
  const std::array<double, dim + 1> lambda = fem::barycentric<dim>(in_cell);  // of the cell's own vertices
  Point<dim> sorted;
  for (int i = 0; i < dim; ++i) sorted[i] = lambda[local[i + 1]];
  return sorted;
}

/// The vertices of a cell in ascending order.
template <int dim>
[[nodiscard]] mesh::Cell<dim> sorted_vertices(mesh::Cell<dim> cell)
{
  std::ranges::sort(cell);
  return cell;
}

/// J with x = x_0 + J xhat for the cell with these vertices.
template <int dim>
[[nodiscard]] Tensor<dim> jacobian_of(const mesh::Mesh<dim>& mesh, const mesh::Cell<dim>& vertices);

/// Cell c of the mesh.
template <int dim>
[[nodiscard]] SortedCell<dim> make_sorted_cell(const mesh::Mesh<dim>& mesh, Index c);

}  // namespace tribound::certify
