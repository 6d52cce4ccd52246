#include "tribound/algebra/dense.h"

#include <algorithm>
#include <limits>

#include "tribound/algebra/petsc_detail.h"
// Must follow PETSc's other headers: it is not self-contained.
#include <petscblaslapack.h>

#include "tribound/base/norm.h"

namespace tribound::algebra
{

void detail::add_product(double a, std::span<const double> matrix, std::size_t rows, std::size_t columns,
                         bool transposed, std::span<const double> x, std::span<double> y)
{
  const auto m = static_cast<PetscBLASInt>(rows);
  const auto n = static_cast<PetscBLASInt>(columns);
  const PetscBLASInt one = 1;
  const double beta = 1;
  BLASgemv_(transposed ? "T" : "N", &m, &n, &a, matrix.data(), &m, x.data(), &one, &beta, y.data(), &one);
}

std::vector<double> detail::solve_dense(const std::vector<double>& m, std::span<const double> r,
                                        double tolerance)
{
  constexpr int max_refinements = 3;
  constexpr double lost = 1e-2;     // of the right-hand side
  constexpr double useless = 1e-6;  // of the right-hand side: useful factors leave no more
  std::vector<double> lu = m;
  const auto size = static_cast<PetscBLASInt>(r.size());
  std::vector<PetscBLASInt> pivots(r.size());
  const PetscBLASInt one = 1;
  PetscBLASInt info = 0;
  LAPACKgetrf_(&size, &size, lu.data(), &size, pivots.data(), &info);
  std::vector<double> d(r.size(), 0.0);
  std::vector<double> residual(r.begin(), r.end());
  double before = norm(residual);
  for (int k = 0; info == 0 && k <= max_refinements; ++k)
  {
    std::vector<double> correction = residual;
    LAPACKgetrs_("T", &size, &one, lu.data(), &size, pivots.data(), correction.data(), &size, &info);
    std::vector<double> next = residual;
    add_product(-1, m, r.size(), r.size(), true, correction, next);
    const double after = norm(next);
    if (!(after < before)) break;
    for (std::size_t i = 0; i < d.size(); ++i) d[i] += correction[i];
    residual = std::move(next);
    before = after;
    if (after <= tolerance) break;
  }
  // Where rounding in M d is as large as r, a small residual is an accident.
  const double rounding = std::numeric_limits<double>::epsilon() * norm(m) * norm(d);
  if (info != 0 || rounding > lost * norm(r) || !(before <= std::max(tolerance, useless * norm(r))))
    throw SolveError(detail::singular_tangent);
  return d;
}

}  // namespace tribound::algebra
