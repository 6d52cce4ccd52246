/// @file polynomials_test.cpp
/// The orthonormal basis, checked by its defining properties with quadrature and differences.

#include "tribound/fem/polynomials.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/dimensions.h"
#include "tribound/fem/quadrature.h"

namespace tribound::test
{

namespace
{

constexpr int max_degree = 8;

template <int k>
std::vector<double> values(int degree, const Point<k>& x)
{
  std::vector<double> result(fem::polynomial_dimension(k, degree));
  fem::orthonormal_values<k>(degree, x, result);
  return result;
}

/// Corners, where collapsed coordinates are singular, points on edges, and interior points.
template <int k>
std::vector<Point<k>> sample_points()
{
  std::vector<Point<k>> points{Point<k>::Zero(), Point<k>::Constant(1.0 / (k + 1))};
  for (int i = 0; i < k; ++i) points.push_back(Point<k>::Unit(i));
  for (int i = 0; i < k; ++i) points.push_back((Point<k>::Unit(i) + Point<k>::Unit((i + 1) % k)) / 2);
  points.push_back(Point<k>::LinSpaced(0.1, 0.3));
  return points;
}

template <class T>
class OrthonormalPolynomials : public ::testing::Test
{
};
TYPED_TEST_SUITE(OrthonormalPolynomials, AllDimensions);

TYPED_TEST(OrthonormalPolynomials, AreOrthonormal)
{
  constexpr int k = TypeParam::value;
  const fem::Quadrature<k> rule = fem::quadrature<k>(2 * max_degree);
  const int n = fem::polynomial_dimension(k, max_degree);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  for (int q = 0; q < rule.size(); ++q)
  {
    const std::vector<double> phi = values<k>(max_degree, rule.points[q]);
    const Eigen::Map<const Eigen::VectorXd> column(phi.data(), n);
    gram += rule.weights[q] * column * column.transpose();
  }
  EXPECT_LE((gram - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-12);
}

/// Along a line, a polynomial of degree m has vanishing differences of order m + 1.
TYPED_TEST(OrthonormalPolynomials, FirstOnesSpanThePolynomialsOfLowerDegree)
{
  constexpr int k = TypeParam::value;
  const Point<k> direction = Point<k>::LinSpaced(0.7, -0.4) / k;
  const Point<k> start = Point<k>::Constant(0.05);
  for (int m = 0; m < max_degree; ++m)
  {
    const int n = fem::polynomial_dimension(k, m);
    std::vector<double> difference(n, 0.0);
    std::vector<double> size(n, 0.0);
    double binomial = 1;
    for (int j = 0; j <= m + 1; ++j)
    {
      const std::vector<double> phi = values<k>(max_degree, start + direction * j / (m + 1));
      for (int i = 0; i < n; ++i)
      {
        difference[i] += (j % 2 == 0 ? 1 : -1) * binomial * phi[i];
        size[i] += binomial * std::abs(phi[i]);
      }
      binomial = binomial * (m + 1 - j) / (j + 1);
    }
    for (int i = 0; i < n; ++i) EXPECT_LE(std::abs(difference[i]), 1e-14 * size[i]) << "function " << i;
  }
}

TYPED_TEST(OrthonormalPolynomials, DoNotDependOnTheLargestDegree)
{
  constexpr int k = TypeParam::value;
  for (const Point<k>& x : sample_points<k>())
  {
    const std::vector<double> all = values<k>(max_degree, x);
    for (int m = 0; m < max_degree; ++m)
    {
      const std::vector<double> some = values<k>(m, x);
      EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin())) << "degree " << m;
    }
  }
}

/// By central differences of fourth order.
TYPED_TEST(OrthonormalPolynomials, GradientsAgreeWithDifferences)
{
  constexpr int k = TypeParam::value;
  constexpr double h = 1e-4;
  const int n = fem::polynomial_dimension(k, max_degree);
  std::vector<double> phi(n);
  std::vector<Point<k>> gradients(n);
  for (const Point<k>& x : sample_points<k>())
  {
    fem::orthonormal_gradients<k>(max_degree, x, phi, gradients);
    EXPECT_EQ(phi, values<k>(max_degree, x));
    for (int a = 0; a < k; ++a)
    {
      const auto at = [&](int steps) { return values<k>(max_degree, x + steps * h * Point<k>::Unit(a)); };
      const auto [far_behind, behind, ahead, far_ahead] = std::array{at(-2), at(-1), at(1), at(2)};
      for (int i = 0; i < n; ++i)
      {
        const double difference = (8 * (ahead[i] - behind[i]) - (far_ahead[i] - far_behind[i])) / (12 * h);
        EXPECT_NEAR(difference, gradients[i][a], 1e-8 * (1 + gradients[i].norm()))
            << "function " << i << ", component " << a;
      }
    }
  }
}

TEST(PolynomialDimension, Counts)
{
  EXPECT_EQ(fem::polynomial_dimension(2, -1), 0);
  EXPECT_EQ(fem::polynomial_dimension(1, 5), 6);
  EXPECT_EQ(fem::polynomial_dimension(2, 4), 15);
  EXPECT_EQ(fem::polynomial_dimension(3, 4), 35);
}

}  // namespace

}  // namespace tribound::test
