#pragma once

/// @file foreign_solution.h
/// The solution of another program as a function on a mesh of ours.

#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/mesh/import/imported_solution.h"
#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

/// A displacement in P^q, continuous on each body, and a stress that is in P^q on each cell.
template <int dim>
struct ForeignSolution
{
  int degree = 1;                     ///< q
  std::vector<double> u{};            ///< at the degrees of freedom of LagrangeSpace(mesh, q)
  std::vector<Tensor<dim>> stress{};  ///< [cell n_nodes + node]; empty: none
  std::vector<double> hoop{};         ///< beside each stress of a body of revolution that around the axis
  double node_distance = 0;           ///< largest distance of a node from its vertex or its place on a cell
  double curved_distance = 0;         ///< of nodes from their places in the straight element
  bool is_exact = true;               ///< whether it is their function, not one with its values at nodes
  std::string read_as{};              ///< in words
};

/// Finds the nodes by their coordinates, to 1e-6 of the size of the mesh, or 1e-5 where vertices are missing
/// else, and where bodies touch by the elements that they belong to. On simplices with straight edges it is
/// their function; on curved ones of order q that in P^q on straight cells with their values at the nodes.
/// On other elements it is the function in P^2 on the cells into which they were cut that takes their values;
/// at the middles of edges that cut an element, those of its shape functions. Points without elements are in
/// P^q for the largest q whose nodes are all among them.
///
/// Throws InputError for another mesh (tells whether it is larger or shifted), a node without a value or with
/// two, points that may belong to either of two bodies. Of a body of revolution u_r has to vanish on the axis
/// up to rounding, which is left out, and a stress has to have a component zz, which is that around the axis.
template <int dim>
[[nodiscard]] ForeignSolution<dim> foreign_solution(const mesh::ImportedSolution& theirs,
                                                    const mesh::Mesh<dim>& mesh,
                                                    bool is_axisymmetric = false);

/// The function on the mesh that takes, at the nodes of the degree of theirs, the values of their function on
/// another mesh, which covers this one. Throws InputError where it does not, and for points without elements.
template <int dim>
[[nodiscard]] ForeignSolution<dim> interpolated_solution(const mesh::ImportedSolution& theirs,
                                                         const mesh::Mesh<dim>& mesh,
                                                         bool is_axisymmetric = false);

}  // namespace tribound::certify
