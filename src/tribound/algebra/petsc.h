#pragma once

/// @file petsc.h
/// PETSc behind values and RAII. Only the .cpp files of this folder touch Mat, Vec and KSP.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tribound/algebra/blas.h"
#include "tribound/algebra/triplets.h"
#include "tribound/base/types.h"

struct _p_Mat;

namespace tribound::algebra
{

/// MPI (with threads: PT-Scotch deadlocks otherwise), PETSc and a communicator for the matrices. What the
/// program that uses the library has started already is taken as it is, and left running; the rest ends when
/// this is destroyed. One per process, alive as long as matrices and solvers are. Throws SolveError where MPI
/// or PETSc do not start.
class Environment
{
 public:
  Environment();
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  bool started_mpi_ = false;
  bool started_petsc_ = false;
  std::filesystem::path session_directory_;  ///< of Open MPI; empty: not ours
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

/// A square sparse matrix, in PETSc.
class SparseMatrix
{
 public:
  /// Sums the entries; block_size is the number of components per node.
  SparseMatrix(Index n, int block_size, Triplets entries);
  /// From its rows.
  SparseMatrix(int block_size, const SparseRows& rows);

  /// A matrix of the same pattern and values.
  [[nodiscard]] SparseMatrix duplicate() const;
  /// a + b, whose pattern is the union of theirs.
  [[nodiscard]] static SparseMatrix sum(const SparseMatrix& a, const SparseMatrix& b);
  [[nodiscard]] Index size() const { return size_; }
  /// A x.
  [[nodiscard]] std::vector<double> multiply(std::span<const double> x) const;
  [[nodiscard]] std::vector<double> diagonal() const;
  /// New values for the (row, column, value) entries the matrix was made of, in the same order.
  void set_values(std::span<const double> values);
  /// this = a + b again with other values, after sum(a, b).
  void assign_sum(const SparseMatrix& a, const SparseMatrix& b);

  [[nodiscard]] _p_Mat* handle() const { return mat_.get(); }

 private:
  SparseMatrix() = default;
  void create(int block_size);

  Index size_ = 0;
  bool has_more_ = false;  ///< a sum whose second pattern is not within the first
  MatHandle mat_;
};

}  // namespace tribound::algebra
