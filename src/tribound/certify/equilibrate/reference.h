#pragma once

/// @file reference.h
/// Matrices on the reference simplex from which the operators of every cell follow by scaling: derivatives,
/// traces and products with hat functions in orthonormal bases.

#include <algorithm>
#include <array>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/certify/equilibrate/small_dense.h"
#include "tribound/fem/lagrange.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

/// Sizes of the Arnold-Falk-Winther spaces of degree p on one cell.
template <int dim, int p>
struct Sizes
{
  static constexpr int stress = fem::polynomial_dimension(dim, p);  ///< dim P^p(T): one entry of sigma
  static constexpr int multiplier =
      fem::polynomial_dimension(dim, p - 1);  ///< dim P^{p-1}(T): one entry of U, Lambda
  static constexpr int facet = fem::polynomial_dimension(dim - 1, p);  ///< dim P^p(F)
  static constexpr int pairs = dim * (dim - 1) / 2;                    ///< entries of a skew tensor
  static constexpr int u = dim * multiplier;                           ///< dim U
  static constexpr int rotation = pairs * multiplier;                  ///< dim Lambda
  static constexpr int block = dim * facet;                            ///< multipliers of one facet
  static constexpr int rigid = dim + pairs;                            ///< rigid motions
  static constexpr int affine = std::min(multiplier, dim + 1);         ///< functions chi of degree <= 1
};

/// Reference matrices. phi: orthonormal basis of P^p, chi: its part of degree p-1 (both on the cell), theta:
/// orthonormal basis of P^p on the facet, whose vertices are taken in ascending order. Facet i is opposite to
/// vertex i. With D_k = derivative[k], E_f = trace[f], and D'_k, E'_f what they are on P^{p-1}:
template <int dim, int p>
struct Reference
{
  using S = Sizes<dim, p>;
  using MultiplierMatrix = Dense<S::multiplier, S::multiplier>;
  using CouplingMatrix = Dense<S::multiplier, S::facet>;
  using FacetMatrix = Dense<S::facet, S::facet>;

  std::array<Dense<S::multiplier, S::stress>, dim> derivative;  ///< (d_k phi_j, chi_i)
  std::array<Dense<S::facet, S::stress>, dim + 1> trace;        ///< (phi_j, theta_i)_F

  /// D_k D_l^T - D'_k D'_l^T / 2 and D'_k D'_l^T / 2
  std::array<std::array<MultiplierMatrix, dim>, dim> divergence, truncated_divergence;
  /// [k][f]: D_k E_f^T - D'_k E'_f^T / 2 and D'_k E'_f^T / 2
  std::array<std::array<CouplingMatrix, dim + 1>, dim> coupling, truncated_coupling;
  /// [f][g]: E_f E_g^T - E'_f E'_g^T / 2 and E'_f E'_g^T / 2
  std::array<std::array<FacetMatrix, dim + 1>, dim + 1> schur, truncated_schur;

  /// [f][a]: (lambda_a chi_j, theta_i)_F, zero for a = f
  std::array<std::array<Dense<S::facet, S::multiplier>, dim + 1>, dim + 1> hat_trace;
  std::array<MultiplierMatrix, dim + 1> hat;  ///< [a]: (lambda_a chi_j, chi_i)
  Dense<S::multiplier, dim + 1> hat_moment;   ///< (lambda_a, chi_i); chi_i beyond P^1: 0
  Dense<S::facet, dim> facet_hat_moment;      ///< (lambda_v, theta_i)_F, v-th vertex of F
  /// Coefficients of d_k of the Lagrange basis function of node j in chi, the cell's vertices being permuted:
  /// nodal_derivative[permutation_number(SortedCell::local)][k], rows in the order of LagrangeBasis of the
  /// unsorted cell.
  std::vector<std::array<Dense<S::stress, S::multiplier>, dim>> nodal_derivative;

  Reference();
};

/// The matrices of this dimension and degree, made once.
template <int dim, int p>
[[nodiscard]] const Reference<dim, p>& reference();

}  // namespace tribound::certify
