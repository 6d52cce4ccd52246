#pragma once

/// @file solution_error.h
/// The distance of a discrete solution from a reference solution, cell by cell; method section 9.

#include <span>
#include <vector>

#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/overlay.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// The distance of u from a reference, with the share of every cell of the mesh of u: the squares of the
/// shares add up to the square of the whole.
struct LocalError
{
  SolutionError global;
  std::vector<double> energy;   ///< per cell: (sigma(e), eps(e))_T^{1/2}, e = u - u_ref
  std::vector<double> stress;   ///< per cell: ||sigma(e)||_T
  double own_energy = 0;        ///< a(u, u)
  double product = 0;           ///< a(u, u_ref)
  double reference_energy = 0;  ///< a(u_ref, u_ref)
  /// Squares and energies are exact up to this part of themselves: 0 but for integrals over 1/r.
  double doubt = 0;
};

/// ||s - sigma(u_ref)||_{C^-1,T} of each cell, and the part of itself up to which its square is exact.
struct StressError
{
  std::vector<double> cells{};
  double doubt = 0;
};

/// mesh::overlay(). Where `reference` is shared out: its own cells, each with the cell of the first mesh,
/// which `mesh` then is, that it comes from.
template <int dim>
[[nodiscard]] std::vector<mesh::CellPair> cell_pairs(const mesh::Mesh<dim>& mesh,
                                                     const mesh::Mesh<dim>& reference);

/// Integrated exactly over the common refinement of the two meshes, which bisect() makes from one mesh. Of an
/// axisymmetric problem with the weight r and the hoop strain; u_r vanishes on the axis.
/// Either degree may be the higher one. The mesh of the reference may be shared out between ranks: the other
/// one is then the first mesh, whole on each of them, as is the result. Throws std::invalid_argument for
/// other meshes.
template <int dim>
[[nodiscard]] LocalError solution_error(const problem::Problem<dim>& problem,
                                        const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                                        const fem::LagrangeSpace<dim>& reference_space,
                                        std::span<const double> u_ref);

/// Per cell of `space`: ||s - sigma(u_ref)||_{C^-1,T}, with the initial stress in sigma; s is in P^p on each
/// cell, with the values [cell n_nodes + node] at the nodes of `space`. Integrated as above; an initial
/// stress as by a rule of degree 2p + 5. Of an axisymmetric problem `hoop` is the stress around the axis, by
/// its values as those of s.
template <int dim>
[[nodiscard]] StressError stress_error(const problem::Problem<dim>& problem,
                                       const fem::LagrangeSpace<dim>& space, std::span<const Tensor<dim>> s,
                                       std::span<const double> hoop,
                                       const fem::LagrangeSpace<dim>& reference_space,
                                       std::span<const double> u_ref);

}  // namespace tribound::certify
