#pragma once

/// @file lagrange.h
/// Lagrange elements of degree p on the reference simplex, equispaced nodes.

#include <array>
#include <span>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::fem
{

/// Basis functions at points: row q, column i.
template <int k>
struct Tabulation
{
  int n_points = 0;
  int n_nodes = 0;
  std::vector<double> values;       ///< [q * n_nodes + i]
  std::vector<Point<k>> gradients;  ///< [q * n_nodes + i], reference gradients

  [[nodiscard]] std::span<const double> values_at(int q) const
  {
    return std::span(values).subspan(static_cast<std::size_t>(q) * n_nodes, n_nodes);
  }
  [[nodiscard]] std::span<const Point<k>> gradients_at(int q) const
  {
    return std::span(gradients).subspan(static_cast<std::size_t>(q) * n_nodes, n_nodes);
  }
};

/// The nodal basis of P^p on the reference k-simplex.
template <int k>
class LagrangeBasis
{
 public:
  explicit LagrangeBasis(int degree);

  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] int n_nodes() const { return static_cast<int>(nodes_.size()); }
  /// Barycentric coordinates of node i times p, one per vertex (vertex 0 is the origin).
  [[nodiscard]] const std::array<int, k + 1>& node(int i) const { return nodes_[i]; }
  /// Reference coordinates of node i.
  [[nodiscard]] Point<k> node_point(int i) const;
  /// Those of all nodes.
  [[nodiscard]] std::vector<Point<k>> node_points() const;
  [[nodiscard]] Tabulation<k> tabulate(std::span<const Point<k>> points) const;

 private:
  int degree_;
  std::vector<std::array<int, k + 1>> nodes_;
  std::vector<double> coefficients_;  ///< nodal basis in the orthonormal basis, [i * n + j]
};

/// Basis functions of a cell at points of each of its facets.
template <int dim>
struct FacetTabulation
{
  std::vector<Point<dim - 1>> points;             ///< reference facet
  std::array<Tabulation<dim>, dim + 1> on_facet;  ///< per local facet
};

template <int dim>
[[nodiscard]] FacetTabulation<dim> tabulate_on_facets(const LagrangeBasis<dim>& basis,
                                                      std::span<const Point<dim - 1>> points);

/// The integrals of (grad phi_i)(grad phi_j)^T over the reference cell, [i * n_nodes + j].
template <int dim>
[[nodiscard]] std::vector<Tensor<dim>> gradient_products(const LagrangeBasis<dim>& basis);

}  // namespace tribound::fem
