#include "tribound/algebra/cholesky.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "tribound/algebra/petsc_detail.h"

namespace tribound::algebra
{

using detail::check;
using detail::wrap;

namespace
{

/// A zero pivot means that the matrix is not positive definite; any other failure is an error.
bool succeeded(Mat factors)
{
  MatFactorError error = MAT_FACTOR_NOERROR;
  check(MatFactorGetError(factors, &error), "factorising");
  if (error == MAT_FACTOR_OUTMEMORY) check(PETSC_ERR_MEM, "factorising");
  if (error != MAT_FACTOR_NOERROR && error != MAT_FACTOR_NUMERIC_ZEROPIVOT)
    throw SolveError("MUMPS failed while factorising a symmetric matrix");
  return error == MAT_FACTOR_NOERROR;
}

std::atomic<int> factorisations = 0;

}  // namespace

int n_factorisations()
{
  return factorisations;
}

void detail::count_factorisation()
{
  ++factorisations;
}

MatHandle detail::start_cholesky(const SparseMatrix& a, int dim)
{
  check(MatSetOption(a.handle(), MAT_SPD, PETSC_TRUE), "factorising");  // no pivoting
  Mat factors = nullptr;
  check(MatGetFactor(a.handle(), MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factors), "factorising");
  MatHandle result(factors);
  configure_mumps(factors, dim);
  return result;
}

bool detail::factorise_cholesky(const SparseMatrix& a, Mat factors)
{
  MatFactorInfo info;
  check(MatFactorInfoInitialize(&info), "factorising");
  check(MatCholeskyFactorSymbolic(factors, a.handle(), nullptr, &info), "ordering a matrix");
  if (!succeeded(factors)) return false;
  count_factorisation();
  check(MatCholeskyFactorNumeric(factors, a.handle(), &info), "factorising");
  if (!succeeded(factors)) return false;
  PetscInt negative = 0;
  check(MatMumpsGetInfog(factors, 12, &negative), "counting pivots");
  return negative == 0;
}

SparseCholesky::SparseCholesky(const SparseMatrix& a, int dim)
{
  const detail::Options options(false, a.sharing());
  factors_ = detail::start_cholesky(a, dim);
  if (!detail::factorise_cholesky(a, factors_.get())) return;
  // A NaN pivot counts neither as negative nor as zero, but it spoils every solution.
  const std::vector<double> ones(a.size(), 1.0);
  std::vector<double> x(a.size());
  solve(ones, x);
  positive_definite_ = std::ranges::all_of(x, [](double value) { return std::isfinite(value); });
}

void SparseCholesky::solve(std::span<const double> b, std::span<double> x) const
{
  check(MatSolve(factors_.get(), wrap(b).get(), wrap(x).get()), "solving a linear system");
}

}  // namespace tribound::algebra
