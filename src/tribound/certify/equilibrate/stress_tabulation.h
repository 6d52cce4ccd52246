#pragma once

/// @file stress_tabulation.h
/// The basis of the equilibrated stress tabulated at fixed points of a cell, for every way in which the
/// ascending order of its vertices differs from its own (certify/equilibrate/sorted_cell.h).

#include <span>
#include <vector>

#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/certify/equilibrate/stress.h"

namespace tribound::certify
{

/// Values of the orthonormal basis of P^degree(T), up to the factor 1/sqrt(det J).
template <int dim>
class StressTabulation
{
 public:
  /// The points are given in the reference coordinates of the cell as Mesh::cell numbers its vertices.
  StressTabulation(int degree, std::span<const Point<dim>> points);

  [[nodiscard]] int n_points() const { return n_points_; }

  /// values[e * n_points() + q] = entry e = dim * row + column, at point q, of the stress with the given
  /// coefficients on the cell; `block` is empty where the stress vanishes.
  void evaluate(const SortedCell<dim>& cell, std::span<const double> block, std::span<double> values) const;

 private:
  int n_points_;
  int n_;                                   ///< dim P^degree
  std::vector<std::vector<double>> basis_;  ///< [permutation_number(cell.local)][j * n_points + q]
};

}  // namespace tribound::certify
