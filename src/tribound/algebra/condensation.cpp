#include "tribound/algebra/condensation.h"

#include <algorithm>
#include <utility>

#include "tribound/algebra/petsc_detail.h"
// After PETSc's other headers: it does not stand alone.
#include <petscblaslapack.h>

#include "tribound/base/norm.h"

namespace tribound::algebra
{

using detail::check;
using detail::wrap;

namespace
{

/// y += a A x for a column-major A of the given shape, or with its transpose.
void add_product(double a, std::span<const double> matrix, PetscBLASInt rows, PetscBLASInt columns,
                 bool transposed, std::span<const double> x, std::span<double> y)
{
  const PetscBLASInt one = 1;
  const double beta = 1;
  BLASgemv_(transposed ? "T" : "N", &rows, &columns, &a, matrix.data(), &rows, x.data(), &one, &beta,
            y.data(), &one);
}

/// The dense Cholesky factor that MUMPS and PETSc leave, column by column: a view.
class SchurFactor
{
 public:
  explicit SchurFactor(Mat factors) : factors_(factors)
  {
    check(MatFactorFactorizeSchurComplement(factors_), "condensing a matrix");
    check(MatFactorGetSchurComplement(factors_, &schur_, &status_), "condensing a matrix");
    check(MatDenseGetArrayRead(schur_, &entries_), "condensing a matrix");
  }
  ~SchurFactor()
  {
    MatDenseRestoreArrayRead(schur_, &entries_);
    MatFactorRestoreSchurComplement(factors_, &schur_, status_);
  }
  SchurFactor(const SchurFactor&) = delete;
  SchurFactor& operator=(const SchurFactor&) = delete;

  [[nodiscard]] const double* entries() const { return entries_; }

 private:
  Mat factors_;
  Mat schur_ = nullptr;
  MatFactorSchurStatus status_ = MAT_FACTOR_SCHUR_FACTORED;
  const double* entries_ = nullptr;
};

}  // namespace

Condensation::Condensation(int dim, SparseRows k, std::vector<Index> layer, std::vector<Index> trace,
                           std::span<const double> b)
    : layer_(std::move(layer)), trace_(std::move(trace)), position_(b.size(), -1), sprung_(b.size())
{
  int position = 0;
  for (const Index i : layer_) position_[i] = position++;
  for (const Index i : trace_) position_[i] = position++;
  for (const Index i : trace_)
  {
    double& diagonal = k.diagonal(i);
    penalty_.push_back(diagonal);
    diagonal *= 2;
  }
  factorise(SparseMatrix(dim, k), dim);
  check(MatSolve(factors_.get(), wrap(b).get(), wrap(std::span(sprung_)).get()), "solving a linear system");
  condense();
}

void Condensation::factorise(const SparseMatrix& k, int dim)
{
  const detail::Options options(false, {});
  factors_ = detail::start_cholesky(k, dim);
  std::vector<PetscInt> kept(layer_.begin(), layer_.end());
  kept.insert(kept.end(), trace_.begin(), trace_.end());
  IS rows = nullptr;
  check(ISCreateGeneral(detail::communicator(), static_cast<PetscInt>(kept.size()), kept.data(),
                        PETSC_USE_POINTER, &rows),
        "factorising");
  const PetscErrorCode error = MatFactorSetSchurIS(factors_.get(), rows);
  ISDestroy(&rows);
  check(error, "factorising");
  if (!detail::factorise_cholesky(k, factors_.get()))
    throw SolveError("the stiffness matrix is not positive definite");
}

/// With the Cholesky factor [L_LL 0; L_GL L_GG] of the Schur complement on layer and trace:
/// W^T = L_GL L_LL^{-1} and S = L_GG L_GG^T - D.
void Condensation::condense()
{
  const SchurFactor schur(factors_.get());
  const auto n_layer = static_cast<PetscBLASInt>(layer_.size());
  const auto n_trace = static_cast<PetscBLASInt>(trace_.size());
  const PetscBLASInt n = n_layer + n_trace;
  const double one = 1;
  const double zero = 0;

  const auto lower = [&](PetscBLASInt column) { return schur.entries() + std::size_t(column) * n + n_layer; };
  w_.reserve(std::size_t(n_trace) * n_layer);
  for (PetscBLASInt j = 0; j < n_layer; ++j) w_.insert(w_.end(), lower(j), lower(j) + n_trace);
  BLAStrsm_("R", "L", "N", "N", &n_trace, &n_layer, &one, schur.entries(), &n, w_.data(), &n_trace);

  std::vector<double> factor(std::size_t(n_trace) * n_trace, 0.0);
  for (PetscBLASInt j = 0; j < n_trace; ++j)
    std::copy(lower(n_layer + j) + j, lower(n_layer + j) + n_trace,
              factor.begin() + std::ptrdiff_t(j) * n_trace + j);
  s_.resize(factor.size());
  BLASsyrk_("L", "N", &n_trace, &n_trace, &one, factor.data(), &n_trace, &zero, s_.data(), &n_trace);
  for (PetscBLASInt j = 0; j < n_trace; ++j)
    for (PetscBLASInt i = 0; i < j; ++i) s_[std::size_t(j) * n_trace + i] = s_[std::size_t(i) * n_trace + j];

  std::vector<double> sprung_trace;
  for (const Index i : trace_) sprung_trace.push_back(sprung_[i]);
  load_ = multiply(sprung_trace);  // before D is taken out of S
  for (PetscBLASInt i = 0; i < n_trace; ++i) s_[std::size_t(i) * n_trace + i] -= penalty_[i];
}

std::vector<double> Condensation::multiply(std::span<const double> x) const
{
  std::vector<double> y(trace_.size(), 0.0);
  const auto n = static_cast<PetscBLASInt>(trace_.size());
  add_product(1, s_, n, n, false, x, y);
  return y;
}

std::vector<double> Condensation::deviation(std::span<const double> x) const
{
  std::vector<double> difference(x.begin(), x.end());
  for (std::size_t i = 0; i < trace_.size(); ++i) difference[i] -= sprung_[trace_[i]];
  return difference;
}

std::vector<double> Condensation::on_layer(std::span<const double> x) const
{
  std::vector<double> u;
  u.reserve(layer_.size());
  for (const Index i : layer_) u.push_back(sprung_[i]);
  add_product(-1, w_, static_cast<PetscBLASInt>(trace_.size()), static_cast<PetscBLASInt>(layer_.size()),
              true, deviation(x), u);
  return u;
}

/// (K + D)(u - (K + D)^{-1} b) acts on the trace alone, where it is (S + D)(x - its trace).
std::vector<double> Condensation::expand(std::span<const double> x) const
{
  const std::vector<double> of_trace = deviation(x);
  const std::vector<double> force = multiply(of_trace);
  std::vector<double> b(sprung_.size(), 0.0);
  for (std::size_t i = 0; i < trace_.size(); ++i) b[trace_[i]] = force[i] + penalty_[i] * of_trace[i];
  std::vector<double> u(sprung_.size());
  check(MatSolve(factors_.get(), wrap(std::span<const double>(b)).get(), wrap(std::span(u)).get()),
        "solving a linear system");
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += sprung_[i];
  return u;
}

/// Column i is row i of S + N_GG - N_GL W: its sums run over columns of W^T.
std::vector<double> Condensation::transposed_tangent(const Triplets& n) const
{
  const auto n_layer = static_cast<int>(layer_.size());
  const auto n_trace = static_cast<PetscBLASInt>(trace_.size());
  const PetscBLASInt one = 1;
  std::vector<double> m = s_;
  for (std::size_t e = 0; e < n.rows.size(); ++e)
  {
    if (n.rows[e] < 0 || n.cols[e] < 0) continue;
    double* row = m.data() + std::size_t(position_[n.rows[e]] - n_layer) * n_trace;
    const int column = position_[n.cols[e]];
    const double a = -n.values[e];
    if (column >= n_layer)
      row[column - n_layer] -= a;
    else
      BLASaxpy_(&n_trace, &a, w_.data() + std::size_t(column) * n_trace, &one, row, &one);
  }
  return m;
}

std::vector<double> Condensation::solve(const Triplets& n, std::span<const double> r, double tolerance) const
{
  constexpr int max_refinements = 3;
  constexpr double useless = 1e-6;  // of the right-hand side: as little is left by factors that are of use
  const std::vector<double> m = transposed_tangent(n);
  std::vector<double> lu = m;
  const auto size = static_cast<PetscBLASInt>(trace_.size());
  std::vector<PetscBLASInt> pivots(trace_.size());
  const PetscBLASInt one = 1;
  PetscBLASInt info = 0;
  LAPACKgetrf_(&size, &size, lu.data(), &size, pivots.data(), &info);
  std::vector<double> d(trace_.size(), 0.0);
  std::vector<double> residual(r.begin(), r.end());
  double before = norm(residual);
  for (int k = 0; info == 0 && k <= max_refinements; ++k)
  {
    std::vector<double> correction = residual;
    LAPACKgetrs_("T", &size, &one, lu.data(), &size, pivots.data(), correction.data(), &size, &info);
    std::vector<double> next = residual;
    add_product(-1, m, size, size, true, correction, next);
    const double after = norm(next);
    if (!(after < before)) break;
    for (std::size_t i = 0; i < d.size(); ++i) d[i] += correction[i];
    residual = std::move(next);
    before = after;
    if (after <= tolerance) break;
  }
  if (info != 0 || !(before <= std::max(tolerance, useless * norm(r))))
    throw SolveError(detail::singular_tangent);
  return d;
}

}  // namespace tribound::algebra
