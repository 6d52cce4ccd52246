/// @file poincare_korn_test.cpp
/// No polynomial exceeds the constants, on any shape; on the simplices where they were proven they are sharp.
/// All integrals are those of Bernstein polynomials, which the program does not use here.

#include "tribound/certify/bound/poincare_korn.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/constants.h"

namespace tribound::test
{

namespace
{

using Matrix = Eigen::MatrixXd;

double factorial(int n)
{
  return std::tgamma(n + 1.0);
}

template <int dim>
using Exponents = std::array<int, dim + 1>;
template <int dim>
using Vertices = std::array<Point<dim>, dim + 1>;

template <int dim>
std::vector<Exponents<dim>> exponents(int degree)
{
  std::vector<Exponents<dim>> result;
  Exponents<dim> alpha{};
  const auto add = [&](const auto& self, int i, int left) -> void
  {
    alpha[i] = left;
    if (i == dim) return result.push_back(alpha);
    for (alpha[i] = 0; alpha[i] <= left; ++alpha[i]) self(self, i + 1, left - alpha[i]);
  };
  add(add, 0, degree);
  return result;
}

/// The average of two Bernstein polynomials of one degree over a simplex with n + 1 vertices.
template <int dim>
double average(const Exponents<dim>& a, const Exponents<dim>& b, int degree, int n)
{
  double product = 1;
  for (int i = 0; i <= dim; ++i) product *= factorial(a[i] + b[i]) / (factorial(a[i]) * factorial(b[i]));
  return product * std::pow(factorial(degree), 2) * factorial(n) / factorial(2 * degree + n);
}

/// Vector fields of one degree on a simplex.
template <int dim>
class BernsteinFields
{
 public:
  explicit BernsteinFields(int degree)
      : degree_(degree), alphas_(exponents<dim>(degree)), below_(exponents<dim>(degree - 1))
  {
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        products_[i][j] = derivative(i).transpose() * averages(below_, degree - 1) * derivative(j);
  }

  /// sup ||w - r||^2 / ||eps(w)||^2 of the cell, then of each facet, from below.
  [[nodiscard]] std::vector<double> quotients(const Vertices<dim>& x, int n_steps) const
  {
    Tensor<dim> jacobian;
    for (int i = 0; i < dim; ++i) jacobian.col(i) = x[i + 1] - x[0];
    const double volume = std::abs(jacobian.determinant()) / factorial(dim);
    const Tensor<dim> inverse = jacobian.inverse();
    std::array<Point<dim>, dim + 1> gradients;
    gradients[0].setZero();
    for (int i = 0; i < dim; ++i)
    {
      gradients[i + 1] = inverse.row(i).transpose();
      gradients[0] -= gradients[i + 1];
    }
    const Matrix rigid = rigid_motions(x);
    const Matrix mass = vector_form(averages(alphas_, degree_) * volume);
    Matrix energy = strain(gradients) * volume;
    const Matrix moments = mass * rigid;
    energy += moments * inverse_of(moments.transpose() * rigid) * moments.transpose();
    const Matrix factor = CholeskyFactors(energy).lower();
    std::vector<double> result{largest(factor, mass, rigid, n_steps)};
    for (int i = 0; i <= dim; ++i)
      result.push_back(
          largest(factor, vector_form(on_facet(i) * (volume * dim * gradients[i].norm())), rigid, n_steps));
    return result;
  }

 private:
  [[nodiscard]] Matrix averages(const std::vector<Exponents<dim>>& alphas, int degree, int without = -1) const
  {
    Matrix result = Matrix::Zero(alphas.size(), alphas.size());
    for (std::size_t i = 0; i < alphas.size(); ++i)
      for (std::size_t j = 0; j < alphas.size(); ++j)
        if (without < 0 || (alphas[i][without] == 0 && alphas[j][without] == 0))
          result(i, j) = average<dim>(alphas[i], alphas[j], degree, without < 0 ? dim : dim - 1);
    return result;
  }
  [[nodiscard]] Matrix on_facet(int i) const { return averages(alphas_, degree_, i); }

  /// d/d lambda_i B_alpha = degree B_(alpha - e_i).
  [[nodiscard]] Matrix derivative(int i) const
  {
    Matrix result = Matrix::Zero(below_.size(), alphas_.size());
    for (std::size_t j = 0; j < alphas_.size(); ++j)
    {
      Exponents<dim> alpha = alphas_[j];
      if (alpha[i]-- == 0) continue;
      result(std::ranges::find(below_, alpha) - below_.begin(), j) = degree_;
    }
    return result;
  }

  [[nodiscard]] Matrix vector_form(const Matrix& scalar) const
  {
    const auto n = scalar.rows();
    Matrix result = Matrix::Zero(dim * n, dim * n);
    for (int a = 0; a < dim; ++a) result.block(a * n, a * n, n, n) = scalar;
    return result;
  }

  /// eps(p e_a) : eps(q e_b) = (delta_ab grad p . grad q + d_b p d_a q) / 2.
  [[nodiscard]] Matrix strain(const std::array<Point<dim>, dim + 1>& gradients) const
  {
    const auto n = static_cast<Eigen::Index>(alphas_.size());
    Matrix result = Matrix::Zero(dim * n, dim * n);
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        for (int i = 0; i <= dim; ++i)
          for (int j = 0; j <= dim; ++j)
          {
            result.block(a * n, b * n, n, n) += gradients[i][b] * gradients[j][a] / 2 * products_[i][j];
            if (a == b)
              result.block(a * n, a * n, n, n) += gradients[i].dot(gradients[j]) / 2 * products_[i][j];
          }
    return result;
  }

  /// A linear function has the coefficients that are its values at alpha / degree.
  [[nodiscard]] Matrix rigid_motions(const Vertices<dim>& x) const
  {
    const auto n = static_cast<Eigen::Index>(alphas_.size());
    Matrix result = Matrix::Zero(dim * n, dim * (dim + 1) / 2);
    for (Eigen::Index k = 0; k < n; ++k)
    {
      Point<dim> y = Point<dim>::Zero();
      for (int i = 0; i <= dim; ++i) y += alphas_[k][i] * x[i] / degree_;
      for (int a = 0; a < dim; ++a) result(a * n + k, a) = 1;
      int column = dim;
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < a; ++b, ++column)
        {
          result(a * n + k, column) = y[b];
          result(b * n + k, column) = -y[a];
        }
    }
    return result;
  }

  /// The largest quotient of the form, rigid motions projected out, by power iteration.
  [[nodiscard]] static double largest(const Matrix& energy, const Matrix& form, const Matrix& rigid,
                                      int n_steps)
  {
    const Matrix moments = form * rigid;
    const Matrix gram = inverse_of(rigid.transpose() * moments);
    Eigen::VectorXd y = Eigen::VectorXd::Random(form.rows());
    double quotient = 0;
    for (int step = 0; step < n_steps; ++step)
    {
      const Eigen::VectorXd w = solve_lower_transposed(energy, y);  // ||y||^2 is its energy
      const Eigen::VectorXd image = form * w - moments * (gram * (moments.transpose() * w));
      quotient = w.dot(image) / y.squaredNorm();
      y = solve_lower(energy, image).normalized();
    }
    return quotient;
  }

  int degree_;
  std::vector<Exponents<dim>> alphas_;
  std::vector<Exponents<dim>> below_;
  std::array<std::array<Matrix, dim + 1>, dim + 1> products_;
};

template <int dim>
Vertices<dim> hill_simplex(double gram)
{
  Tensor<dim> products = Tensor<dim>::Constant(gram);
  products.diagonal().setOnes();
  const Tensor<dim> edges = CholeskyFactors(products).lower().transpose();
  Vertices<dim> result;
  result[0].setZero();
  for (int i = 0; i < dim; ++i) result[i + 1] = result[i] + edges.col(i);
  return result;
}

/// constants / those of polynomials: of the cell and the facets.
template <int dim>
std::vector<double> ratios(const BernsteinFields<dim>& fields, const Vertices<dim>& x, int n_steps)
{
  const certify::PoincareKorn<dim> found = certify::poincare_korn<dim>(x);
  std::vector<double> result = fields.quotients(x, n_steps);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = (i == 0 ? found.cell : found.facets[i - 1]) / std::sqrt(result[i]);
  return result;
}

template <int dim>
void expect_sharp(const char* name, const certify::KornConstants<dim>& known, int degree)
{
  const std::vector<double> found =
      ratios<dim>(BernsteinFields<dim>(degree), hill_simplex<dim>(known.gram), 400);
  fmt::print("{:<21} {:.3f}\n", name, fmt::join(found, " "));
  for (const double ratio : found)
  {
    EXPECT_GE(ratio, 1) << name;
    EXPECT_LE(ratio, 2) << name;
  }
}

TEST(PoincareKorn, IsSharpWhereItWasProven)
{
  expect_sharp<2>("right triangle", certify::right_triangle, 7);
  expect_sharp<2>("equilateral triangle", certify::equilateral_triangle, 7);
  expect_sharp<3>("disphenoid", certify::disphenoid, 5);
  expect_sharp<3>("path tetrahedron", certify::path_tetrahedron, 5);
}

template <int dim>
void expect_no_polynomial_above(int degree, int n_shapes)
{
  const BernsteinFields<dim> fields(degree);
  std::mt19937 random(dim);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  double smallest = HUGE_VAL;
  for (int shape = 0; shape < n_shapes; ++shape)
  {
    const double flatness = std::pow(10, coordinate(random));
    Vertices<dim> x;
    for (Point<dim>& vertex : x)
      for (int i = 0; i < dim; ++i) vertex[i] = coordinate(random) * (i == 0 ? flatness : 1);
    for (const double ratio : ratios<dim>(fields, x, 30)) smallest = std::min(smallest, ratio);
  }
  fmt::print("{}D: at least {:.3f} times the constants of polynomials\n", dim, smallest);
  EXPECT_GE(smallest, 1);
}

TEST(PoincareKorn, NoPolynomialExceedsItOnAnyTriangle)
{
  expect_no_polynomial_above<2>(4, 1000);
}

TEST(PoincareKorn, NoPolynomialExceedsItOnAnyTetrahedron)
{
  expect_no_polynomial_above<3>(3, 1000);
}

/// Lengths grow with the simplex; turning it and numbering its vertices change nothing.
TEST(PoincareKorn, FollowsTheSimplex)
{
  const Vertices<3> x{Point<3>(0, 0.1, 0), Point<3>(1, 0, 0.2), Point<3>(0.3, 1.1, 0),
                      Point<3>(0.1, 0.2, 0.9)};
  const certify::PoincareKorn<3> found = certify::poincare_korn<3>(x);
  const Tensor<3> turn = Eigen::AngleAxisd(0.7, Point<3>(1, 2, 3).normalized()).toRotationMatrix();
  Vertices<3> y;
  for (int i = 0; i < 4; ++i) y[(i + 1) % 4] = 4 * (turn * x[i]);
  const certify::PoincareKorn<3> moved = certify::poincare_korn<3>(y);
  EXPECT_NEAR(moved.cell, 4 * found.cell, 1e-12);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(moved.facets[(i + 1) % 4], 2 * found.facets[i], 1e-12);
}

}  // namespace

}  // namespace tribound::test
