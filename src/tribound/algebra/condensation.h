#pragma once

/// @file condensation.h
/// Static condensation: a linear problem reduced to a few of its unknowns, exactly.

#include <cstdint>
#include <span>
#include <vector>

#include "tribound/algebra/petsc.h"
#include "tribound/base/ranks.h"
#include "tribound/base/types.h"

namespace tribound::algebra
{

/// K u = b + f with symmetric K and forces f that act on the trace unknowns alone, reduced to them:
/// S x = g + f for x = u on the trace, S = K_GG - K_GR K_RR^{-1} K_RG (R: the rest, G: the trace), and
/// u = u_0 - W x on a layer of unknowns beside the trace. K may be singular where only the trace holds a
/// body.
///
/// MUMPS factorises K without layer and trace and leaves the Schur complement C on these. Dense factors by
/// LAPACK then give S = C_GG - C_GL C_LL^{-1} C_LG and W = C_LL^{-1} C_LG. Elsewhere u follows from its
/// values on layer and trace by the sparse factors.
///
/// On several ranks u and b have entries for all unknowns of the rank. x and all other vectors on trace or
/// layer have entries for the unknowns of all ranks, the same everywhere; the first rank has the dense
/// matrices. All ranks call the members together.
class Condensation
{
 public:
  /// `k`: the rows of K of own unknowns. `layer` and `trace` are disjoint lists of own unknowns; over all
  /// ranks the trace is not empty. `dim` is that of the mesh and selects the ordering. Throws SolveError when
  /// K with the trace held is not positive definite.
  Condensation(int dim, SparseRows k, std::vector<Index> layer, std::vector<Index> trace,
               std::span<const double> b, Sharing sharing = {});

  /// Number of unknowns of all ranks on the trace.
  [[nodiscard]] std::size_t n_trace() const { return n_trace_; }
  /// The entries of `values` on the trace, and on layer and trace.
  [[nodiscard]] std::vector<double> on_trace(std::span<const double> values) const;
  [[nodiscard]] std::vector<double> on_layer_and_trace(std::span<const double> values) const;
  /// u on layer and trace.
  [[nodiscard]] std::vector<double> near(std::span<const double> x) const;
  /// Sets u at the unknowns of this rank on layer and trace, ghosts included.
  void put(std::span<const double> layer_and_trace, std::span<double> u) const;
  /// u everywhere but at ghosts: a solve with the sparse factors.
  [[nodiscard]] std::vector<double> expand(std::span<const double> x) const { return expand(near(x), b_); }
  /// The same with another b for given values on layer and trace.
  [[nodiscard]] std::vector<double> expand(std::span<const double> layer_and_trace,
                                           std::span<const double> b) const;
  /// u everywhere but at ghosts for each b: K u = b, and the same with layer and trace held. As fast as
  /// expand(), and three at once in little more time than one. solve_whole() only where there is no layer; K
  /// must be positive definite.
  [[nodiscard]] std::vector<std::vector<double>> solve_whole(std::span<const std::vector<double>> b) const;
  [[nodiscard]] std::vector<std::vector<double>> solve_held(std::span<const std::vector<double>> b) const;

  /// Replaces b.
  void set_load(std::span<const double> b);
  /// g.
  [[nodiscard]] std::span<const double> load() const { return load_; }
  /// S x.
  [[nodiscard]] std::vector<double> multiply(std::span<const double> x) const;
  /// Solves (S + N_GG - N_GL W) d = r up to `tolerance` (absolute, Euclidean) or round-off, by LU factors.
  /// `n` has rows on the trace and columns on trace and layer; only rows of own unknowns count. Throws
  /// SolveError when the matrix is singular to working precision.
  [[nodiscard]] std::vector<double> solve(const Triplets& n, std::span<const double> r,
                                          double tolerance) const;

 private:
  /// An entry on layer and trace.
  struct Entry
  {
    int row;
    int column;
    double value;
  };

  void find_places(Index n_unknowns);
  void factorise(const SparseMatrix& k, int dim);
  void couple(const SparseRows& k);
  void condense();
  [[nodiscard]] bool owns(Index unknown) const;
  /// The values at these unknowns of all ranks, everywhere.
  [[nodiscard]] std::vector<double> of_all(std::span<const Index> own, std::span<const double> values) const;
  [[nodiscard]] std::vector<std::vector<double>> solve_sparse(std::span<const std::vector<double>> b,
                                                              int schur) const;
  /// The result of work() on the first rank, everywhere.
  template <class Work>
  [[nodiscard]] std::vector<double> by_first(const Work& work) const;
  [[nodiscard]] std::vector<double> transposed_tangent(std::span<const Entry> n) const;

  Ranks ranks_;
  Sharing sharing_;
  int block_size_;
  std::vector<Index> layer_;            ///< own unknowns
  std::vector<Index> trace_;            ///< own unknowns
  std::vector<std::int64_t> all_kept_;  ///< of all ranks, layer first, as the matrix numbers its rows
  std::size_t n_layer_ = 0;             ///< of all ranks
  std::size_t n_trace_ = 0;             ///< of all ranks
  std::vector<int> position_;           ///< of an unknown of this rank in all_kept_; -1 for others
  std::vector<Entry> coupling_;         ///< K: row an own unknown of the rest, column in all_kept_
  MatHandle factors_;
  std::vector<double> b_;
  std::vector<double> s_;           ///< S, by columns; on the first rank
  std::vector<double> w_;           ///< W^T, by columns; on the first rank
  std::vector<double> layer_load_;  ///< u_0
  std::vector<double> load_;
};

}  // namespace tribound::algebra
