#include "tribound/certify/bound/eigenvalue_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tribound/algebra/cholesky.h"
#include "tribound/base/dense_factors.h"
#include "tribound/base/norm.h"

namespace tribound::certify
{

namespace
{

/// An approximation of the smallest eigenvalue of A w = lambda M w: the largest of A^{-1} M by Lanczos'
/// method in the inner product of M. Without orthogonalisation: lost orthogonality repeats eigenvalues and
/// does not spoil the extreme ones [Paige80].
double smallest_eigenvalue(const algebra::SparseMatrix& a, const algebra::SparseMatrix& m, int dim)
{
  constexpr int max_steps = 200;
  constexpr double accuracy = 1e-9;
  const algebra::SparseCholesky cholesky(a, dim);
  if (!cholesky.positive_definite()) return 0;
  const auto n = static_cast<std::size_t>(a.size());
  std::vector<double> v(n, 1.0);
  std::vector<double> previous(n, 0.0);
  std::vector<double> mv = m.multiply(v);
  std::vector<double> w(n);
  std::vector<double> diagonal;
  std::vector<double> off_diagonal;  // entry i couples i and i + 1, the last one is for the next step
  double beta = std::sqrt(inner_product(v, mv));
  double largest = 0;
  for (int k = 0; k < max_steps; ++k)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      v[i] /= beta;
      mv[i] /= beta;
    }
    cholesky.solve(mv, w);
    diagonal.push_back(inner_product(w, mv));
    for (std::size_t i = 0; i < n; ++i) w[i] -= diagonal.back() * v[i] + (k > 0 ? beta : 0) * previous[i];

    const double before = largest;
    largest = tridiagonal_eigenvalues(Eigen::Map<Eigen::VectorXd>(diagonal.data(), k + 1),
                                      Eigen::Map<Eigen::VectorXd>(off_diagonal.data(), k))[k];
    if (k > 1 && largest - before <= accuracy * largest) break;

    std::swap(previous, v);
    std::swap(v, w);
    mv = m.multiply(v);
    beta = std::sqrt(std::max(0.0, inner_product(v, mv)));
    if (beta <= accuracy * largest) break;  // v spans an invariant subspace
    off_diagonal.push_back(beta);
  }
  return 1 / largest;
}

/// Rounding in the factors of A - theta M, of the order of eps a_ii on the diagonal, changes the smallest
/// eigenvalue by this fraction if its eigenvector is spread over the body; a safety factor of 100 is
/// included.
double rounding_of(const Pencil& pencil, double lambda)
{
  double trace = 0;
  double volume = 0;
  for (std::size_t k = 0; k < pencil.m.size(); ++k)
  {
    if (pencil.a.rows[k] == pencil.a.cols[k]) trace += pencil.a.values[k];
    volume += pencil.m[k];
  }
  return 100 * std::numeric_limits<double>::epsilon() * trace / (lambda * volume);
}

}  // namespace

double proved_theta(Pencil pencil, int dim)
{
  if (pencil.n == 0) return std::numeric_limits<double>::infinity();  // no function is left
  algebra::SparseMatrix shifted(pencil.n, 1, pencil.a);
  algebra::Triplets mass{pencil.a.rows, pencil.a.cols, pencil.m};
  const double lambda = smallest_eigenvalue(shifted, {pencil.n, 1, std::move(mass)}, dim);
  std::vector<double> values(pencil.m.size());
  for (double shortfall = std::max(1e-6, rounding_of(pencil, lambda)); shortfall < 1; shortfall *= 10)
  {
    const double theta = (1 - shortfall) * lambda;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = pencil.a.values[k] - theta * pencil.m[k];
    shifted.set_values(values);
    if (algebra::SparseCholesky(shifted, dim).positive_definite()) return theta;
  }
  return 0;
}

}  // namespace tribound::certify
