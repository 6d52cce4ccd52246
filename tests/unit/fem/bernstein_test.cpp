/// @file bernstein_test.cpp
/// Coefficients in the Bernstein basis: they determine the polynomial and enclose it.

#include "tribound/fem/bernstein.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <vector>

namespace tribound::test
{

namespace
{

template <int k>
Eigen::VectorXd coefficients(const fem::Quadrature<k>& rule, int degree, const Eigen::VectorXd& values)
{
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<double> matrix = fem::bernstein_from_points<k>(rule, degree);
  const auto n = static_cast<Eigen::Index>(matrix.size()) / values.size();
  return Eigen::Map<const RowMajor>(matrix.data(), n, values.size()) * values;
}

TEST(Bernstein, AQuadraticHasItsKnownCoefficients)
{
  // x^2 = B_2 on the segment; (x - 1/2)^2 has the coefficients 1/4, -1/4, 1/4.
  const fem::Quadrature<1> rule = fem::quadrature<1>(4);
  Eigen::VectorXd values(rule.size());
  for (int q = 0; q < rule.size(); ++q) values[q] = std::pow(rule.points[q][0] - 0.5, 2);
  const Eigen::VectorXd b = coefficients<1>(rule, 2, values);
  EXPECT_NEAR(b[0], 0.25, 1e-14);
  EXPECT_NEAR(b[1], -0.25, 1e-14);
  EXPECT_NEAR(b[2], 0.25, 1e-14);
}

/// A random polynomial of the given degree: a sum of powers of affine functions.
template <int k>
void expect_enclosure(int degree, std::mt19937& dice)
{
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Point<k + 1>> affine(4);
  for (Point<k + 1>& a : affine)
    for (int i = 0; i <= k; ++i) a[i] = number(dice);
  const auto f = [&](const Point<k>& x)
  {
    double sum = 0;
    for (const Point<k + 1>& a : affine)
      sum += a[1] * std::pow(a[0] + a.template tail<k>().dot(x), degree) + a[0];
    return sum;
  };
  const fem::Quadrature<k> rule = fem::quadrature<k>(2 * degree);
  Eigen::VectorXd values(rule.size());
  for (int q = 0; q < rule.size(); ++q) values[q] = f(rule.points[q]);
  const Eigen::VectorXd b = coefficients<k>(rule, degree, values);
  constexpr int m = 40;
  double at_corner = 1;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= (k == 1 ? 0 : m - i); ++j)
    {
      Point<k> x = Point<k>::Constant(static_cast<double>(j) / m);
      x[0] = static_cast<double>(i) / m;
      EXPECT_LE(b.minCoeff(), f(x) + 1e-12);
      EXPECT_GE(b.maxCoeff(), f(x) - 1e-12);
      if (i == m) at_corner = (b.array() - f(x)).abs().minCoeff();
    }
  EXPECT_LT(at_corner, 1e-12) << "a coefficient is the value at the corner";
}

TEST(Bernstein, CoefficientsEnclosePolynomials)
{
  std::mt19937 dice(7);
  for (int trial = 0; trial < 20; ++trial)
    for (int degree = 1; degree <= 6; ++degree)
    {
      expect_enclosure<1>(degree, dice);
      expect_enclosure<2>(degree, dice);
    }
}

/// From nodal values to coefficients, against the definition |a|!/a! lambda^a, and back.
template <int k>
void expect_transformed(int degree, std::mt19937& dice)
{
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const fem::LagrangeBasis<k> basis(degree);
  const int n = basis.n_nodes();
  std::uniform_real_distribution<double> number(-1, 1);
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return number(dice); });
  const std::vector<double> to_values = fem::values_from_bernstein<k>(basis);
  const std::vector<double> from_values = fem::bernstein_from_values<k>(basis);
  const Eigen::VectorXd values = Eigen::Map<const RowMajor>(to_values.data(), n, n) * b;
  for (int i = 0; i < n; ++i)
  {
    double sum = 0;
    for (int j = 0; j < n; ++j)
    {
      double product = std::tgamma(degree + 1);
      for (int l = 0; l <= k; ++l)
        product *= std::pow(static_cast<double>(basis.node(i)[l]) / degree, basis.node(j)[l]) /
                   std::tgamma(basis.node(j)[l] + 1);
      sum += product * b[j];
    }
    EXPECT_NEAR(values[i], sum, 1e-14);
  }
  const Eigen::VectorXd back = Eigen::Map<const RowMajor>(from_values.data(), n, n) * values;
  EXPECT_LE((back - b).cwiseAbs().maxCoeff(), 1e-15 * std::pow(4, degree));
}

TEST(Bernstein, CoefficientsAtNodesAreThoseOfValues)
{
  std::mt19937 dice(9);
  for (int degree = 1; degree <= 5; ++degree)
  {
    expect_transformed<1>(degree, dice);
    expect_transformed<2>(degree, dice);
  }
}

}  // namespace

}  // namespace tribound::test
