#pragma once

/// @file linear_solver.h
/// Linear systems of a Newton loop: factorisations kept as preconditioners, or multigrid.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "tribound/algebra/multigrid.h"
#include "tribound/algebra/petsc.h"
#include "tribound/fem/space.h"

struct _p_KSP;
struct _p_Vec;

namespace tribound::algebra
{

enum class LinearMethod
{
  automatic,
  direct,     ///< LU factors of the whole matrix
  condensed,  ///< the problem condensed onto the contact boundary, with dense LU factors
  iterative   ///< multigrid
};

/// As in case files: "auto", "direct", "condensed", "iterative".
[[nodiscard]] const char* to_string(LinearMethod method);

enum class DirectPackage
{
  automatic,
  mumps,
  umfpack
};

struct SolverOptions
{
  LinearMethod method = LinearMethod::automatic;
  DirectPackage package = DirectPackage::automatic;
  double tolerance = 1e-10;  ///< relative residual of an iterative solve
  double gamma_alg = 0.05;   ///< alg may be this fraction of the bound; 0: solved to the tolerance
  int max_iterations = 500;
};

struct KspDeleter
{
  void operator()(_p_KSP* ksp) const;
};

/// What solving one linear system took.
struct LinearSolve
{
  int iterations = 0;       ///< of GMRES
  bool factorised = false;  ///< whether a new factorisation or multigrid hierarchy was made
  bool fell_back = false;   ///< whether multigrid failed and the direct solver took its place
};

/// Whether the residual b - A x is small enough; its entries at ghosts mean nothing. All ranks call it
/// together.
using ResidualTest = std::function<bool(std::span<const double>)>;

/// What is known about a matrix. If it is symmetric positive definite, a direct solver computes only half of
/// the factors.
enum class MatrixKind
{
  general,
  positive_definite
};

/// Whole Newton loops of a Tresca block from scratch, p = 1, 2, 3: multigrid takes 0.33, 0.29, 0.47 of the
/// time of MUMPS at 3k to 6k degrees of freedom; on adaptive meshes of 4k to 9k, with few steps, 1.2 to 0.7
/// (bench/README.md).
inline constexpr Index direct_limit_3d = 5'000;

/// Direct or iterative for a whole matrix, as configured or by dimension and size: a factorisation in 2D at
/// every size that fits, in 3D up to `direct_limit` degrees of freedom. `condensed` is treated as automatic.
[[nodiscard]] LinearMethod choose_method(const SolverOptions& config, int dim, std::int64_t n_dofs,
                                         Index direct_limit = direct_limit_3d);

/// Solves the linear systems of one Newton loop by flexible GMRES, preconditioned by a factorisation (then
/// one iteration is the rule) or by multigrid. The preconditioner is kept for the next systems as long as the
/// additional iterations cost less than a new one. If multigrid fails and was not asked for by name, a
/// factorisation takes its place for the rest of the loop.
class LinearSolver
{
 public:
  /// For matrices of this space: multigrid goes through lower degrees and coarser meshes. All ranks call this
  /// and solve() together.
  template <int dim>
  LinearSolver(const SolverOptions& config, const fem::LagrangeSpace<dim>& space,
               MatrixKind kind = MatrixKind::general, Index direct_limit = direct_limit_3d);
  /// For other matrices; `nodes`: positions of the nodes; degree of freedom dim * node + component.
  template <int dim>
  LinearSolver(const SolverOptions& config, std::span<const Point<dim>> nodes,
               MatrixKind kind = MatrixKind::general, Index direct_limit = direct_limit_3d);

  /// Computes x with |A x - b| <= tolerance (absolute, Euclidean) up to round-off, or with a residual that
  /// the test, if there is one, finds small enough; on several ranks x includes the values of ghosts. Throws
  /// SolveError when A is singular or the iteration stalls.
  LinearSolve solve(const SparseMatrix& a, std::span<const double> b, double tolerance, std::span<double> x,
                    const ResidualTest& small_enough = {});

  /// All matrices to come are a constant one plus `part`, whose entries are among theirs and which always has
  /// its values for the matrix being solved with. Multigrid is then renewed at the cost of the part.
  void set_changing_part(const SparseMatrix& part) { changing_ = part.handle(); }

  [[nodiscard]] LinearMethod method() const { return method_; }

 private:
  [[nodiscard]] LinearSolve solve_owned(const SparseMatrix& a, _p_Vec* b, double tolerance, _p_Vec* x,
                                        const ResidualTest& small_enough);
  [[nodiscard]] LinearSolve attempt(const SparseMatrix& a, _p_Vec* b, double tolerance, _p_Vec* x,
                                    const ResidualTest& small_enough);
  [[nodiscard]] int patience(std::int64_t n) const;
  void configure(const SparseMatrix& a);
  void configure_direct(const SparseMatrix& a);
  [[nodiscard]] _p_PC* preconditioner() const;
  void prepare(const SparseMatrix& a, _p_Mat* product);

  SolverOptions config_;
  LinearMethod method_;
  MatrixKind kind_;
  int dim_;
  std::optional<Multigrid> multigrid_;  ///< unless the method is direct
  std::unique_ptr<_p_KSP, KspDeleter> ksp_;
  _p_Mat* changing_ = nullptr;  ///< see set_changing_part()
  int reuse_budget_ =
      0;  ///< iterations with the old preconditioner that cost less than a new one; 0: none yet
};

}  // namespace tribound::algebra
