#pragma once

/// @file reference.h
/// Matrices on the reference simplex from which the operators of every cell follow by scaling: derivatives,
/// traces and products with hat functions in orthonormal bases.

#include <array>
#include <vector>

#include "base/types.h"
#include "fem/lagrange.h"
#include "fem/polynomials.h"

namespace tribound
{

/// Sizes of the Arnold-Falk-Winther spaces of degree p on one cell.
template <int dim, int p>
struct Sizes
{
  static constexpr int stress = polynomial_dimension(dim, p);  ///< dim P^p(T): one entry of sigma
  static constexpr int multiplier =
      polynomial_dimension(dim, p - 1);                           ///< dim P^{p-1}(T): one entry of U, Lambda
  static constexpr int facet = polynomial_dimension(dim - 1, p);  ///< dim P^p(F)
  static constexpr int pairs = dim * (dim - 1) / 2;               ///< entries of a skew tensor
  static constexpr int u = dim * multiplier;                      ///< dim U
  static constexpr int rotation = pairs * multiplier;             ///< dim Lambda
  static constexpr int block = dim * facet;                       ///< multipliers of one facet
  static constexpr int rigid = dim + pairs;                       ///< rigid motions
};

template <int rows, int cols>
using Block = Eigen::Matrix<double, rows, cols, cols == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

/// Reference matrices. phi: orthonormal basis of P^p, chi: its part of degree p-1 (both on the cell), theta:
/// orthonormal basis of P^p on the facet, whose vertices are taken in ascending order. Facet i is opposite to
/// vertex i.
template <int dim, int p>
struct Reference
{
  using S = Sizes<dim, p>;

  std::array<Block<S::multiplier, S::stress>, dim> derivative;  ///< (d_k phi_j, chi_i)
  std::array<Block<S::facet, S::stress>, dim + 1> trace;        ///< (phi_j, theta_i)_F
  /// derivative[k] * trace[f]^T
  std::array<std::array<Block<S::multiplier, S::facet>, dim + 1>, dim> derivative_trace;
  /// trace[f] * trace[g]^T
  std::array<std::array<Block<S::facet, S::facet>, dim + 1>, dim + 1> trace_trace;
  /// derivative[k] * derivative[l]^T
  std::array<std::array<Block<S::multiplier, S::multiplier>, dim>, dim> derivative_derivative;
  /// [f][a]: (lambda_a chi_j, theta_i)_F, zero for a = f
  std::array<std::array<Block<S::facet, S::multiplier>, dim + 1>, dim + 1> hat_trace;
  std::array<Block<S::multiplier, S::multiplier>, dim + 1> hat;  ///< [a]: (lambda_a chi_j, chi_i)
  Block<S::multiplier, dim + 1> hat_moment;                      ///< (lambda_a, chi_i)
  Block<S::facet, dim> facet_hat_moment;                         ///< (lambda_v, theta_i)_F, v-th vertex of F
  /// Coefficients of d_k of the Lagrange basis function of node j in chi, the cell's vertices being permuted:
  /// nodal_derivative[permutation_number(frame.local)][k], columns in the order of LagrangeBasis of the
  /// unsorted cell.
  std::vector<std::array<Block<S::multiplier, S::stress>, dim>> nodal_derivative;

  Reference();
};

/// The matrices of this dimension and degree, made once.
template <int dim, int p>
[[nodiscard]] const Reference<dim, p>& reference();

}  // namespace tribound
