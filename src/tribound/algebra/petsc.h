#pragma once

/// @file petsc.h
/// PETSc behind values and RAII. Only the .cpp files of this folder touch Mat, Vec and KSP.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tribound/algebra/blas.h"
#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"
#include "tribound/fem/node_numbers.h"

struct _p_Mat;

namespace tribound::algebra
{

/// MPI (with threads: PT-Scotch deadlocks otherwise) and PETSc. Whatever the program that uses the library
/// has started already is used as it is and left running; the rest ends when this is destroyed. Throws
/// SolveError if MPI or PETSc does not start.
class Libraries
{
 public:
  Libraries();
  ~Libraries();
  Libraries(const Libraries&) = delete;
  Libraries& operator=(const Libraries&) = delete;

 private:
  bool started_mpi_ = false;
  bool started_petsc_ = false;
  std::filesystem::path session_directory_;  ///< of Open MPI; empty: not ours
};

/// The libraries, with communicators for the matrices and errors of PETSc as exceptions. One at a time, alive
/// as long as matrices and solvers are. A program that makes several, one after the other, keeps its own
/// Libraries: MPI does not start twice.
class Environment
{
 public:
  Environment();
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  Libraries libraries_;
};

/// Names and versions of the libraries behind the linear algebra.
struct AlgebraVersions
{
  std::string petsc;
  std::string mumps;
  std::string mpi;
  BlasFacts blas;
};
[[nodiscard]] AlgebraVersions algebra_versions();

struct MatDeleter
{
  void operator()(_p_Mat* mat) const;
};
using MatHandle = std::unique_ptr<_p_Mat, MatDeleter>;

/// How nodes are shared out between ranks; null: this process has them all.
using Sharing = std::shared_ptr<const fem::NodeNumbers>;

/// A square sparse matrix, in PETSc. On several ranks each has the rows of its own nodes. Vectors then have
/// entries for all unknowns of the rank; those of ghosts are not read, and are 0 in results.
class SparseMatrix
{
 public:
  /// Sums the entries; block_size is the number of components per node. Rows and columns are local; rows of
  /// ghosts are left out.
  SparseMatrix(Index n, int block_size, Triplets entries, Sharing sharing = {});
  /// From its rows, on several ranks those of the own nodes; columns are local.
  SparseMatrix(int block_size, SparseRows rows, Sharing sharing = {});

  /// A matrix of the same pattern and values.
  [[nodiscard]] SparseMatrix duplicate() const;
  /// a + b, whose pattern is the union of theirs.
  [[nodiscard]] static SparseMatrix sum(const SparseMatrix& a, const SparseMatrix& b);
  /// Unknowns of this rank, ghosts included.
  [[nodiscard]] Index size() const { return size_; }
  /// Unknowns of all ranks, without ghosts.
  [[nodiscard]] std::int64_t global_size() const;
  [[nodiscard]] const Sharing& sharing() const { return sharing_; }
  [[nodiscard]] int block_size() const { return block_size_; }
  /// A x.
  [[nodiscard]] std::vector<double> multiply(std::span<const double> x) const;
  [[nodiscard]] std::vector<double> diagonal() const;
  /// New values for the (row, column, value) entries the matrix was made of, in the same order.
  void set_values(std::span<const double> values);
  /// this = a + b again with other values of b, after sum(a, b).
  void assign_sum(const SparseMatrix& a, const SparseMatrix& b);

  [[nodiscard]] _p_Mat* handle() const { return mat_.get(); }

 private:
  SparseMatrix() = default;
  /// On one rank: a matrix like the given one, with these rows.
  SparseMatrix(const SparseMatrix& like, SparseRows rows);
  void create();
  void take(SparseRows rows);
  void settle();

  Index size_ = 0;
  int block_size_ = 1;
  Sharing sharing_;
  bool has_more_ = false;    ///< on several ranks: a sum whose second pattern is not contained in the first
  SparseRows rows_;          ///< on one rank: the memory of mat_
  std::vector<int> places_;  ///< in rows_, of the entries it was made of
  MatHandle mat_;
};

}  // namespace tribound::algebra
