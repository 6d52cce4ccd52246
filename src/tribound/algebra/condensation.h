#pragma once

/// @file condensation.h
/// Static condensation: a linear problem reduced to a few of its unknowns, exactly.

#include <memory>
#include <span>
#include <vector>

#include "tribound/algebra/petsc.h"
#include "tribound/base/types.h"

namespace tribound::algebra
{

/// K u = b + f with symmetric K and forces f that act on the trace unknowns alone, reduced to them:
/// S x = g + f for x = u on the trace, S = K_GG - K_GR K_RR^{-1} K_RG (R: the rest, G: the trace), and
/// u = u_0 - W x on a layer of unknowns beside the trace. One sparse Cholesky factorisation by MUMPS, which
/// leaves the Schur complement on layer and trace; dense factors by LAPACK do the rest.
///
/// K may be singular where the trace alone holds a body: factorised is K + D, with the diagonal of K in D on
/// the trace, whose Schur complement is that of K plus D.
class Condensation
{
 public:
  /// `k`: K; `layer` and `trace` are distinct unknowns, neither is empty. `dim` is that of the mesh and
  /// selects the ordering. Throws SolveError when K + D is not positive definite.
  Condensation(int dim, SparseRows k, std::vector<Index> layer, std::vector<Index> trace,
               std::span<const double> b);

  [[nodiscard]] std::span<const Index> layer() const { return layer_; }
  [[nodiscard]] std::span<const Index> trace() const { return trace_; }
  /// g.
  [[nodiscard]] std::span<const double> load() const { return load_; }
  /// S x.
  [[nodiscard]] std::vector<double> multiply(std::span<const double> x) const;
  /// u on the layer.
  [[nodiscard]] std::vector<double> on_layer(std::span<const double> x) const;
  /// u everywhere: two solves with the sparse factors.
  [[nodiscard]] std::vector<double> expand(std::span<const double> x) const;

  /// d with (S + N_GG - N_GL W) d = r up to `tolerance` (absolute, Euclidean) or round-off, by LU factors;
  /// `n` has rows on the trace, columns on trace and layer. Throws SolveError when the matrix is singular to
  /// working precision.
  [[nodiscard]] std::vector<double> solve(const Triplets& n, std::span<const double> r,
                                          double tolerance) const;

 private:
  void factorise(const SparseMatrix& k, int dim);
  void condense();
  /// x - trace of (K + D)^{-1} b
  [[nodiscard]] std::vector<double> deviation(std::span<const double> x) const;
  [[nodiscard]] std::vector<double> transposed_tangent(const Triplets& n) const;

  std::vector<Index> layer_;
  std::vector<Index> trace_;
  std::vector<int> position_;  ///< of an unknown in [layer, trace]; -1 for others
  MatHandle factors_;
  std::vector<double> sprung_;   ///< (K + D)^{-1} b
  std::vector<double> penalty_;  ///< D on the trace
  std::vector<double> s_;        ///< S, by columns
  std::vector<double> w_;        ///< W^T, by columns
  std::vector<double> load_;
};

}  // namespace tribound::algebra
