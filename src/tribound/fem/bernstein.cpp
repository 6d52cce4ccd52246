#include "tribound/fem/bernstein.h"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/fem/polynomials.h"

namespace tribound::fem
{

namespace
{

/// All (a_1, ..., a_k) with a sum of at most the degree; a_0 is the remainder.
template <int k>
std::vector<Eigen::Array<int, k, 1>> exponents(int degree)
{
  std::vector<Eigen::Array<int, k, 1>> all;
  for (int i = 0; i <= degree; ++i)
    if constexpr (k == 1)
      all.emplace_back(i);
    else
      for (int j = 0; j <= degree - i; ++j) all.emplace_back(i, j);
  return all;
}

/// |a|!/a! lambda(x)^a.
template <int k>
double bernstein(int degree, const Eigen::Array<int, k, 1>& a, const Point<k>& x)
{
  const std::array<double, k + 1> lambda = barycentric<k>(x);
  const int first = degree - a.sum();
  double value = std::tgamma(degree + 1) / std::tgamma(first + 1) * std::pow(lambda[0], first);
  for (int i = 0; i < k; ++i) value *= std::pow(lambda[i + 1], a[i]) / std::tgamma(a[i] + 1);
  return value;
}

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// B_a at node i of the basis, a that of node j, in more digits than a double: the inverse has all digits.
template <int k>
LongMatrix bernstein_at_nodes(const LagrangeBasis<k>& basis)
{
  const int n = basis.n_nodes();
  LongMatrix values = LongMatrix::Ones(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int l = 0, rest = basis.degree(); l <= k; ++l)
        for (int m = 1; m <= basis.node(j)[l]; ++m, --rest)
          values(i, j) *= static_cast<long double>(rest * basis.node(i)[l]) / (m * basis.degree());
  return values;
}

std::vector<double> rounded(const LongMatrix& matrix)
{
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> result = matrix.cast<double>();
  return {result.data(), result.data() + result.size()};
}

}  // namespace

// With theta orthonormal, q = sum_j theta_j sum_i w_i theta_j(x_i) q(x_i), because the rule is exact for
// q theta_j; the coefficients of theta_j in Bernstein's basis follow from its values on a lattice.
template <int k>
std::vector<double> bernstein_from_points(const Quadrature<k>& rule, int degree)
{
  const int n = polynomial_dimension(k, degree);
  const auto lattice = exponents<k>(degree);
  Eigen::MatrixXd basis(n, n);
  Eigen::MatrixXd theta(n, n);
  std::vector<double> values(n);
  for (int i = 0; i < n; ++i)
  {
    const Point<k> x = lattice[i].matrix().template cast<double>() / degree;
    for (int j = 0; j < n; ++j) basis(i, j) = bernstein<k>(degree, lattice[j], x);
    orthonormal_values<k>(degree, x, values);
    for (int j = 0; j < n; ++j) theta(i, j) = values[j];
  }
  Eigen::MatrixXd moments(n, rule.size());
  for (int q = 0; q < rule.size(); ++q)
  {
    orthonormal_values<k>(degree, rule.points[q], values);
    for (int j = 0; j < n; ++j) moments(j, q) = rule.weights[q] * values[j];
  }
  std::vector<double> result(static_cast<std::size_t>(n) * rule.size());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      result.data(), n, rule.size()) = solve_regular(basis, theta * moments);
  return result;
}

template <int k>
std::vector<double> values_from_bernstein(const LagrangeBasis<k>& basis)
{
  return rounded(bernstein_at_nodes(basis));
}

template <int k>
std::vector<double> bernstein_from_values(const LagrangeBasis<k>& basis)
{
  return rounded(bernstein_at_nodes(basis).partialPivLu().inverse());
}

template std::vector<double> values_from_bernstein(const LagrangeBasis<1>&);
template std::vector<double> values_from_bernstein(const LagrangeBasis<2>&);
template std::vector<double> bernstein_from_values(const LagrangeBasis<1>&);
template std::vector<double> bernstein_from_values(const LagrangeBasis<2>&);
template std::vector<double> bernstein_from_points(const Quadrature<1>&, int);
template std::vector<double> bernstein_from_points(const Quadrature<2>&, int);

}  // namespace tribound::fem
