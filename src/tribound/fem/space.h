#pragma once

/// @file space.h
/// Continuous vector-valued P^p Lagrange spaces on a mesh.

#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/lagrange.h"
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

 private:
  const mesh::Mesh<dim>* mesh_;
  LagrangeBasis<dim> basis_;
  Index n_nodes_ = 0;
  std::vector<Index> cell_nodes_;
};

/// The degrees of freedom that Gamma_D fixes.
struct Constraints
{
  std::vector<char> fixed;     ///< per degree of freedom
  std::vector<double> values;  ///< u_D at fixed degrees of freedom, else 0

  [[nodiscard]] Index n_fixed() const;
};

/// Nodal interpolation of u_D. Throws InputError where two boundaries prescribe different values for one
/// component at a common node.
template <int dim>
[[nodiscard]] Constraints dirichlet(const problem::Problem<dim>& problem, const LagrangeSpace<dim>& space);

}  // namespace tribound::fem
