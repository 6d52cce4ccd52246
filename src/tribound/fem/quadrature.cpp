#include "tribound/fem/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tribound/base/dense_factors.h"
#include "tribound/fem/symmetric_rules.h"

namespace tribound::fem
{

namespace
{

/// Makes the rule on [0, 1] exactly symmetric under t -> 1 - t, as it is up to rounding; points ascend.
void make_symmetric(Quadrature<1>& rule)
{
  for (int i = 0, j = rule.size() - 1; i <= j; ++i, --j)
  {
    const double right = 0.5 * (1 + (rule.points[j][0] - rule.points[i][0]));  // 1 - t is exact for t >= 1/2
    rule.points[j][0] = right;
    rule.points[i][0] = 1 - right;
    rule.weights[i] = rule.weights[j] = 0.5 * (rule.weights[i] + rule.weights[j]);
  }
}

/// The n-point Gauss rule on [0, 1] for the weight (1 - t)^alpha, from the eigenvalues of the Jacobi matrix
/// (Golub and Welsch 1969). For alpha = 0 it is symmetric under t -> 1 - t to the last digit. Rounding leaves
/// the eigenvalues symmetric only up to some units of it, which depend on how a compiler contracts products.
Quadrature<1> gauss_jacobi(int n, int alpha)
{
  Eigen::VectorXd diagonal(n);
  Eigen::VectorXd offdiagonal(n - 1);
  for (int i = 0; i < n; ++i)
  {
    const double s = 2.0 * i + alpha;
    diagonal[i] = alpha == 0 ? 0.0 : -double(alpha) * alpha / (s * (s + 2));
    if (i == 0) diagonal[i] = -alpha / (alpha + 2.0);
    if (i > 0) offdiagonal[i - 1] = 2.0 * i * (i + alpha) / (s * std::sqrt((s + 1) * (s - 1)));
  }
  const SymmetricEigen eigen = tridiagonal_eigen(diagonal, offdiagonal);

  Quadrature<1> rule;
  for (int i = 0; i < n; ++i)
  {
    rule.points.emplace_back(0.5 * (eigen.values[i] + 1));
    rule.weights.push_back(std::pow(eigen.vectors(0, i), 2) / (alpha + 1));
  }
  if (alpha == 0) make_symmetric(rule);
  return rule;
}

/// All points of all orbits.
template <int k>
Quadrature<k> rule_of(std::span<const Orbit<k>> orbits)
{
  constexpr double measure = k == 2 ? 1.0 / 2 : 1.0 / 6;
  Quadrature<k> rule;
  for (const Orbit<k>& orbit : orbits)
  {
    std::array<double, k + 1> lambda = orbit.lambda;
    std::ranges::sort(lambda);
    do
    {
      rule.points.push_back(Eigen::Map<const Point<k>>(lambda.data() + 1));
      rule.weights.push_back(measure * orbit.weight);
    } while (std::ranges::next_permutation(lambda).found);
  }
  return rule;
}

/// Gauss-Jacobi in collapsed coordinates: x_j = t_j (1 - t_1) ... (1 - t_{j-1}).
template <int k>
Quadrature<k> collapsed_rule(int n)
{
  std::array<Quadrature<1>, k> line;
  for (int j = 0; j < k; ++j) line[j] = gauss_jacobi(n, k - 1 - j);

  int n_points = 1;
  for (int j = 0; j < k; ++j) n_points *= n;
  Quadrature<k> rule;
  rule.points.reserve(n_points);
  rule.weights.reserve(n_points);
  for (int q = 0; q < n_points; ++q)
  {
    Point<k> point;
    double weight = 1;
    double rest = 1;
    for (int j = 0, digits = q; j < k; ++j, digits /= n)
    {
      const double t = line[j].points[digits % n][0];
      point[j] = rest * t;
      rest *= 1 - t;
      weight *= line[j].weights[digits % n];
    }
    rule.points.push_back(point);
    rule.weights.push_back(weight);
  }
  return rule;
}

}  // namespace

template <int k>
Quadrature<k> quadrature(int degree)
{
  if constexpr (k > 1)
  {
    const std::span<const Orbit<k>> orbits = symmetric_rule<k>(degree);
    if (!orbits.empty()) return rule_of(orbits);
  }
  return collapsed_rule<k>(degree / 2 + 1);
}

template Quadrature<1> quadrature<1>(int);
template Quadrature<2> quadrature<2>(int);
template Quadrature<3> quadrature<3>(int);

}  // namespace tribound::fem
