#pragma once

/// @file row_operator.h
/// The minimisation on one cell for stresses without symmetry, whose rows are independent, method
/// section 4.6.
///
/// Every row is the problem of cell_operator.h without rotations: with B the weak divergence of a vector
/// field of degree p and N its normal traces,
///
///     row = G - B^T eta - N^T mu,   A eta = r - C mu,   A = B B^T,   r = B G - beta,   C = B N^T,
///     N row = g - S mu,             S = N N^T - C^T A^{-1} C,   g = N G - C^T A^{-1} r.
///
/// A, C and S are the same for all rows: column c of a matrix of data belongs to row c of the stress.

#include <array>

#include "tribound/certify/equilibrate/cell_operator.h"

namespace tribound::certify
{

/// What an elimination leaves that does not depend on the data.
template <int dim, int p>
class RowOperator
{
 public:
  using S = Sizes<dim, p>;
  static constexpr int dimension = dim;
  static constexpr int block = S::facet;  ///< multipliers of a facet
  /// Columns of all facets, those of facet f from f * facet_stride on.
  static constexpr int facet_stride = padded(block);
  static constexpr int all_facets = (dim + 1) * facet_stride;
  using CellRows = Dense<S::multiplier, dim>;
  using FacetRows = Dense<S::facet, dim>;
  using AllFacetRows = std::array<FacetRows, dim + 1>;

  /// Factors A and forms the couplings C of all facets. Throws SolveError for a cell without volume. The
  /// metric is that of L2: no other makes rows independent.
  void build(const SortedCell<dim>& cell, const StressMetric& metric = {});
  /// Forms S; build() has been called.
  void condense(const SortedCell<dim>& cell);

  /// The rows of S that belong to facet f, distance all_facets.
  [[nodiscard]] const double* schur(int f) const { return schur_.row(f * block); }

  /// load -= C^T A^{-1} r.
  void subtract_load(AllFacetRows& load, const CellRows& r) const;

  /// sigma - G for the data r and the multipliers mu.
  [[nodiscard]] StressCoefficients<dim, p> correction(const SortedCell<dim>& cell, const CellRows& r,
                                                      const AllFacetRows& mu) const;

 private:
  static constexpr int width = FacetRows::stride;

  [[nodiscard]] CellRows reduce(const CellRows& r) const;

  Dense<S::multiplier, S::multiplier> factor_;    ///< U with A = U^T U
  std::array<double, S::multiplier> reciprocal_;  ///< of its diagonal
  Dense<S::multiplier, all_facets> coupling_;     ///< U^{-T} C
  Dense<(dim + 1) * block, all_facets> schur_;
};

}  // namespace tribound::certify
