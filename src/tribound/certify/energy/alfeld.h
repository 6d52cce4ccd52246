#pragma once

/// @file alfeld.h
/// Symmetric stresses on the barycentric (Alfeld) split of a cell: dim + 1 pieces; piece i has the barycentre
/// in place of vertex i. Vertices are those of a sorted cell (certify/equilibrate/sorted_cell.h).

#include <array>
#include <cmath>
#include <span>

#include "tribound/base/types.h"
#include "tribound/certify/equilibrate/small_dense.h"
#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/fem/polynomials.h"
#include "tribound/problem/material.h"

namespace tribound::certify
{

/// Sizes of the stresses of degree q on the pieces of one cell.
template <int dim, int q>
struct AlfeldSizes
{
  static constexpr int pieces = dim + 1;
  static constexpr int components = dim * (dim + 1) / 2;               ///< of a symmetric tensor
  static constexpr int scalar = fem::polynomial_dimension(dim, q);     ///< dim P^q(T)
  static constexpr int less = fem::polynomial_dimension(dim, q - 1);   ///< dim P^{q-1}(T)
  static constexpr int facet = fem::polynomial_dimension(dim - 1, q);  ///< dim P^q(F)
  static constexpr int functions = pieces * scalar;                    ///< of one component
  static constexpr int unknowns = components * functions;
  static constexpr int facets = pieces + components;  ///< outer ones, and one inside between any two pieces
  static constexpr int rigid = components;            ///< rigid motions
  static constexpr int rows = dim * (facets * facet + pieces * less);  ///< tractions and divergence
  /// Dimension of the stresses without divergence, jumps and traction: 0, 3, 9, 18 (2D) and 0, 18, 66, 156
  /// (3D) for q = 1, 2, 3, 4. All rows are independent except for the rigid motions.
  static constexpr int kernel = unknowns - rows + rigid;
  static constexpr int pairs = dim * (dim - 1) / 2;            ///< entries of a skew tensor
  static constexpr int rotation = pairs * (scalar - 1);        ///< skew tensors of P^q(T) of mean 0
  static constexpr int flat = components * padded(functions);  ///< entries of PiecewiseStress in memory
};

/// Entry (a, i * n + j), n = dim P^q, is the coefficient of component a on the j-th function of piece i. The
/// functions are the orthonormal basis of P^q(piece), in the order of fem/polynomials.h and with the vertices
/// of the piece as described above; components are those of symmetric_vector(). So the sum of the squares of
/// all entries is the square of the L2 norm.
template <int dim, int q>
using PiecewiseStress = Dense<AlfeldSizes<dim, q>::components, AlfeldSizes<dim, q>::functions>;

/// A symmetric tensor as a vector of the same norm: the diagonal, then root 2 times the entries above it.
template <int dim>
using SymmetricVector = Eigen::Matrix<double, dim*(dim + 1) / 2, 1>;

/// The row and the column of each of these components.
template <int dim>
inline constexpr auto symmetric_pairs = []
{
  std::array<std::array<int, 2>, dim*(dim + 1) / 2> pairs{};
  for (int r = 0; r < dim; ++r) pairs[r] = {r, r};
  int n = dim;
  for (int r = 0; r < dim; ++r)
    for (int c = r + 1; c < dim; ++c) pairs[n++] = {r, c};
  return pairs;
}();

template <int dim>
[[nodiscard]] SymmetricVector<dim> symmetric_vector(const Tensor<dim>& symmetric)
{
  SymmetricVector<dim> result;
  for (std::size_t a = 0; a < symmetric_pairs<dim>.size(); ++a)
  {
    const auto [r, c] = symmetric_pairs<dim>[a];
    result[a] = r == c ? symmetric(r, c) : M_SQRT1_2 * (symmetric(r, c) + symmetric(c, r));
  }
  return result;
}

/// The inverse of symmetric_vector().
template <int dim>
[[nodiscard]] Tensor<dim> symmetric_tensor(const SymmetricVector<dim>& components)
{
  Tensor<dim> result;
  for (std::size_t a = 0; a < symmetric_pairs<dim>.size(); ++a)
  {
    const auto [r, c] = symmetric_pairs<dim>[a];
    result(r, c) = result(c, r) = r == c ? components[a] : M_SQRT1_2 * components[a];
  }
  return result;
}

/// C^{-1} of symmetric tensors, in these components: 1/2mu on deviators, 1/(2 mu + dim lambda) on pressures.
template <int dim>
[[nodiscard]] Eigen::Matrix<double, dim*(dim + 1) / 2, dim*(dim + 1) / 2> compliance(
    const problem::Material& material)
{
  constexpr int n = dim * (dim + 1) / 2;
  Eigen::Matrix<double, n, n> result = Eigen::Matrix<double, n, n>::Identity() / (2 * material.mu);
  result.template topLeftCorner<dim, dim>().array() +=
      (1 / (2 * material.mu + dim * material.lambda) - 1 / (2 * material.mu)) / dim;
  return result;
}

/// (C^{-1} a, b)_T of two symmetric stresses, a sum of products of deviators and of traces, so that the
/// square of a stress is not negative. In plane stress with the lambda that the material has there.
template <int rows, int cols>
[[nodiscard]] double compliance_product(const problem::Material& material, const Dense<rows, cols>& a,
                                        const Dense<rows, cols>& b)
{
  constexpr int dim = rows == 3 ? 2 : 3;
  static_assert(rows == dim * (dim + 1) / 2);
  double deviators = 0;
  double traces = 0;
  for (int j = 0; j < cols; ++j)
  {
    double trace_a = 0;
    double trace_b = 0;
    for (int r = 0; r < dim; ++r)
    {
      trace_a += a(r, j);
      trace_b += b(r, j);
    }
    for (int r = 0; r < dim; ++r) deviators += (a(r, j) - trace_a / dim) * (b(r, j) - trace_b / dim);
    for (int r = dim; r < rows; ++r) deviators += a(r, j) * b(r, j);
    traces += trace_a * trace_b;
  }
  return deviators / (2 * material.mu) + traces / (dim * (2 * material.mu + dim * material.lambda));
}

/// The coordinates in piece i of a point of the reference cell.
template <int dim>
[[nodiscard]] Point<dim> to_piece(int i, const Point<dim>& xhat)
{
  std::array<double, dim + 1> lambda = fem::barycentric<dim>(xhat);
  const double of_barycentre = lambda[i];
  for (double& l : lambda) l -= of_barycentre;
  lambda[i] = (dim + 1) * of_barycentre;
  Point<dim> y;
  for (int k = 0; k < dim; ++k) y[k] = lambda[k + 1];
  return y;
}

/// The stress in piece i at a point of the cell, given in the reference coordinates of the sorted cell.
template <int dim, int q>
[[nodiscard]] Tensor<dim> value_in_piece(const SortedCell<dim>& cell, const PiecewiseStress<dim, q>& stress,
                                         int i, const Point<dim>& xhat)
{
  constexpr int n = AlfeldSizes<dim, q>::scalar;
  std::array<double, n> phi;
  fem::orthonormal_values<dim>(q, to_piece<dim>(i, xhat), phi);
  SymmetricVector<dim> sum = SymmetricVector<dim>::Zero();
  for (int a = 0; a < AlfeldSizes<dim, q>::components; ++a)
    for (int j = 0; j < n; ++j) sum[a] += phi[j] * stress(a, i * n + j);
  return symmetric_tensor<dim>(std::sqrt((dim + 1) / cell.det) * sum);
}

/// The symmetric part of a polynomial stress on the cell, piece by piece. Coefficient j of entry (r, c) is at
/// (dim * r + c) * n + j in the orthonormal basis of P^m(T), n = dim P^m, m <= q, as in Stress and
/// DiscreteStress. Compiled for each dimension and degree by certify/energy/kernel.cpp.in.
template <int dim, int q>
[[nodiscard]] PiecewiseStress<dim, q> on_pieces(std::span<const double> stress);

}  // namespace tribound::certify
