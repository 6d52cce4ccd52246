#pragma once

/// @file space.h
/// Continuous vector-valued P^p Lagrange spaces on a mesh.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/lagrange.h"
#include "tribound/fem/node_numbers.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::fem
{

/// V_h without boundary conditions. Degree of freedom dim * node + component.
/// Keeps a reference to the mesh.
template <int dim>
class LagrangeSpace
{
 public:
  LagrangeSpace(const mesh::Mesh<dim>& mesh, int degree);

  [[nodiscard]] const mesh::Mesh<dim>& mesh() const { return *mesh_; }
  [[nodiscard]] int degree() const { return basis_.degree(); }
  [[nodiscard]] const LagrangeBasis<dim>& basis() const { return basis_; }
  [[nodiscard]] Index n_nodes() const { return n_nodes_; }
  [[nodiscard]] Index n_dofs() const { return dim * n_nodes_; }
  /// Global nodes of a cell, in the order of basis().
  [[nodiscard]] std::span<const Index> cell_nodes(Index cell) const
  {
    const auto n = static_cast<std::size_t>(basis_.n_nodes());
    return std::span(cell_nodes_).subspan(cell * n, n);
  }
  /// Positions of all nodes.
  [[nodiscard]] std::vector<Point<dim>> node_points() const;

  /// How the nodes are shared out between ranks; null on a whole mesh.
  [[nodiscard]] const std::shared_ptr<const NodeNumbers>& numbers() const { return numbers_; }
  [[nodiscard]] Index n_owned_nodes() const
  {
    return numbers_ ? static_cast<Index>(numbers_->owned.size()) : n_nodes_;
  }
  /// Local numbers of own nodes, ascending, k = 0, ..., n_owned_nodes() - 1.
  [[nodiscard]] Index owned_node(Index k) const { return numbers_ ? numbers_->owned[k] : k; }
  /// Degrees of freedom of all ranks.
  [[nodiscard]] std::int64_t n_global_dofs() const
  {
    return dim * (numbers_ ? numbers_->n : std::int64_t{n_nodes_});
  }
  /// Euclidean product of values at the degrees of freedom of all ranks; ghosts' do not matter. All ranks
  /// call it together, as update().
  [[nodiscard]] double dot(std::span<const double> a, std::span<const double> b) const;
  /// Euclidean length, likewise.
  [[nodiscard]] double norm(std::span<const double> values) const;
  /// Sets the values at nodes of other ranks to those of their owners.
  template <class T>
  void update(std::span<T> values) const
  {
    if (numbers_) numbers_->update(values, dim);
  }

 private:
  const mesh::Mesh<dim>* mesh_;
  LagrangeBasis<dim> basis_;
  Index n_nodes_ = 0;
  std::vector<Index> cell_nodes_;
  std::shared_ptr<const NodeNumbers> numbers_;
};

/// The degrees of freedom that Gamma_D fixes.
struct Constraints
{
  std::vector<char> fixed;     ///< per degree of freedom
  std::vector<double> values;  ///< u_D at fixed degrees of freedom, else 0
};

/// The degrees of freedom of all ranks that are not fixed.
template <int dim>
[[nodiscard]] std::int64_t n_free_dofs(const LagrangeSpace<dim>& space, const Constraints& constraints);

/// Nodal interpolation of u_D; on the axis of an axisymmetric problem u_r = 0. Throws InputError where two
/// boundaries prescribe different values for one
/// component at a common node. All ranks call it together.
template <int dim>
[[nodiscard]] Constraints dirichlet(const problem::Problem<dim>& problem, const LagrangeSpace<dim>& space);

}  // namespace tribound::fem
