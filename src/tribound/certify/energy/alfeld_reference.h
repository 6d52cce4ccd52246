#pragma once

/// @file alfeld_reference.h
/// The constraints of a symmetric stress on the pieces of a cell, solved once on the reference cell. With tau
/// = J tau^ J^T / det, the traction and the divergence of tau follow from those of tau^, so tau has neither
/// jumps nor traction nor divergence if tau^ has none.

#include <vector>

#include "tribound/certify/energy/alfeld.h"

namespace tribound::certify
{

/// The result of alfeld_factors(). Component a, function (i, j) of a stress as in PiecewiseStress, but
/// without padding: at (a * (dim + 1) + i) * n + j.
struct AlfeldFactors
{
  std::vector<double> restriction;  ///< [j * (dim + 1) n + i * n + l]: (phi_j, psi_l) in piece i
  std::vector<double> kernel;   ///< an orthonormal basis of the stresses without jump, traction, divergence
  std::vector<double> lifting;  ///< one stress for each skew function, with the same traction and divergence
  /// From the triangular factor of the constraints: the smallest diagonal entry within the rank, and the
  /// largest entry beyond it, which is rounding.
  double smallest_pivot = 0;
  double largest_rest = 0;
};

/// On the reference cell. Skew functions: pair (r, c), r < c, in the order of skew_pairs, function j = 1,
/// ..., n - 1 of the orthonormal basis phi of P^q(T). At pair * (n - 1) + j - 1 is the stress of least norm
/// with the traction and the divergence of phi_j (e_r e_c^T - e_c e_r^T). It exists because the function, of
/// mean 0, does no work in rotations.
template <int dim>
[[nodiscard]] AlfeldFactors alfeld_factors(int q);

/// The same on the triangle for stresses that vanish on one facet of the cell, opposite to the vertex of this
/// number, q >= 2: the kernel has q - 1 dimensions less. Functions phi_j of the lifting are projected onto
/// those of mean 0 that vanish on the facet.
[[nodiscard]] AlfeldFactors alfeld_factors_without_stress_on(int facet, int q);

/// The same in the layout of the kernels, with products of the basis of the kernel.
template <int dim, int q>
struct AlfeldReference
{
  using S = AlfeldSizes<dim, q>;
  static constexpr int n_products = S::components * (S::components + 1) / 2;

  Dense<S::scalar, S::functions> restriction;
  Dense<S::kernel, S::flat> kernel;
  Dense<S::rotation, S::flat> lifting;
  /// Row k * n_products + m, with m the m-th of the pairs of components (a, b), a <= b: the products of
  /// component a of function k with component b of all functions, plus those of b with a unless a = b.
  Dense<S::kernel * n_products, S::kernel> products;

  AlfeldReference();
};

/// The factors of this dimension and degree, computed once.
template <int dim, int q>
[[nodiscard]] const AlfeldReference<dim, q>& alfeld_reference();

}  // namespace tribound::certify
