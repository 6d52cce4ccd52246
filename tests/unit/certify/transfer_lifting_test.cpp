/// @file transfer_lifting_test.cpp
/// The lifting of what a contact traction loses between meshes: against the field itself.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/dimensions.h"
#include "tribound/certify/bound/transfer.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"
#include "unit/certify/transfer_testing.h"

namespace tribound::test
{

namespace
{

/// r of one row of tractions in 2D, with the integral of r: composite rules, monomials.
class Loss
{
 public:
  Loss(const std::vector<TractionPiece<2>>& pieces, int degree, double length)
      : pieces_(pieces), degree_(degree), length_(length), ends_{0, 1}
  {
    for (const auto& piece : pieces)
      for (const Point<1>& end : piece.part) ends_.push_back(end[0]);
    std::ranges::sort(ends_);
    const int n = degree + 1;
    Eigen::MatrixXd gram(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) gram(i, j) = 1.0 / (i + j + 1);
    Eigen::MatrixXd moments(n, 2);
    for (int i = 0; i < n; ++i)
      moments.row(i) = integral(1, [&](double s) -> Point<2> { return std::pow(s, i) * traction(s); });
    projection_ = gram.fullPivLu().solve(moments);
  }

  [[nodiscard]] const std::vector<double>& ends() const { return ends_; }
  [[nodiscard]] Point<2> traction(double s) const
  {
    Point<2> sum = Point<2>::Zero();
    std::vector<double> theta(degree_ + 1);
    for (const auto& piece : pieces_)
    {
      const double t = (s - piece.part[0][0]) / (piece.part[1][0] - piece.part[0][0]);
      if (t < 0 || t > 1) continue;
      fem::orthonormal_values<1>(degree_, Point<1>(t), theta);
      for (int i = 0; i <= degree_; ++i) sum += theta[i] * piece.coefficients[i];
    }
    return sum;
  }
  [[nodiscard]] Point<2> r(double s) const
  {
    Point<2> sum = traction(s);
    for (int i = 0; i <= degree_; ++i) sum -= std::pow(s, i) * projection_.row(i).transpose();
    return sum;
  }
  /// Integral of r from the first end, by length.
  [[nodiscard]] Point<2> rho(double s) const
  {
    return length_ * integral(s, [&](double t) { return r(t); });
  }
  template <class Function>
  [[nodiscard]] Point<2> integral(double to, const Function& f) const
  {
    const fem::Quadrature<1> rule = fem::quadrature<1>(9);
    Point<2> sum = Point<2>::Zero();
    for (std::size_t k = 0; k + 1 < ends_.size() && ends_[k] < to; ++k)
    {
      const double width = std::min(ends_[k + 1], to) - ends_[k];
      for (int q = 0; q < rule.size(); ++q)
        sum += width * rule.weights[q] * f(ends_[k] + width * rule.points[q][0]);
    }
    return sum;
  }

 private:
  const std::vector<TractionPiece<2>>& pieces_;
  int degree_;
  double length_;
  std::vector<double> ends_;
  Eigen::MatrixXd projection_;  ///< [power, component]
};

/// tau for a given m, from its definition.
class Lifting
{
 public:
  Lifting(const mesh::Mesh<2>& mesh, const mesh::BoundaryFacet& facet, const Loss& loss)
      : loss_(loss), map_(mesh::facet_map(mesh, facet.cell, facet.local))
  {
    const mesh::FacetGeometry<2> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    apex_ = mesh.vertices()[mesh.cell(facet.cell)[facet.local]];
    normal_ = geometry.normal;
    height_ = normal_.dot(map_.origin - apex_);
    tangent_ = map_.jacobian.col(0) / geometry.measure;
    length_ = geometry.measure;
  }

  [[nodiscard]] Tensor<2> at(double s, double z, int m) const
  {
    const Point<2> r = loss_.r(s);
    const double x = tangent_.dot(map_(Point<1>(s)) - apex_);
    return std::pow(1 - z, m - 1) *
           (r * normal_.transpose() + (x * r - m * loss_.rho(s)) / height_ * tangent_.transpose());
  }
  [[nodiscard]] Tensor<2> at(const Point<2>& x, int m) const
  {
    const double z = normal_.dot(map_.origin - x) / height_;
    const Point<2> on_facet = (x - z * apex_) / (1 - z);
    return at(tangent_.dot(on_facet - map_.origin) / length_, z, m);
  }
  [[nodiscard]] Point<2> point(double s, double z) const { return (1 - z) * map_(Point<1>(s)) + z * apex_; }
  [[nodiscard]] double square(int m) const
  {
    const fem::Quadrature<1> up = fem::quadrature<1>(2 * m);
    double of_height = 0;  // of |tau|^2 over that at z = 0, and of the width 1 - z
    for (int j = 0; j < up.size(); ++j)
      of_height += height_ * up.weights[j] * std::pow(1 - up.points[j][0], 2 * (m - 1) + 1);
    const fem::Quadrature<1> along = fem::quadrature<1>(11);
    double sum = 0;
    for (std::size_t k = 0; k + 1 < loss_.ends().size(); ++k)
      for (int i = 0; i < along.size(); ++i)
      {
        const double width = loss_.ends()[k + 1] - loss_.ends()[k];
        sum += width * length_ * along.weights[i] * of_height *
               at(loss_.ends()[k] + width * along.points[i][0], 0, m).squaredNorm();
      }
    return sum;
  }

 private:
  const Loss& loss_;
  mesh::FacetMap<2> map_;
  Point<2> apex_;
  Point<2> normal_;
  Point<2> tangent_;
  double height_ = 0;
  double length_ = 0;
};

/// In 2D the field itself: divergence, traces, norm.
TEST(TransferLifting, IsTheNormOfALifting)
{
  std::mt19937 random(3);
  for (int round = 0; round < 12; ++round)
  {
    SCOPED_TRACE(round);
    const int degree = 1 + round % 4;
    const mesh::Mesh<2> mesh = random_cell<2>(random);
    const mesh::BoundaryFacet facet = first_facet(mesh);
    auto pieces = random_pieces<2>(degree, 2, round % 2, random);
    if (round % 3 == 0) pieces.push_back(random_traction<2>({Point<1>(0.7), Point<1>(0.15)}, degree, random));
    const double length = mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
    const Loss loss(pieces, degree, length);
    const Lifting lifting(mesh, facet, loss);
    EXPECT_LE(loss.rho(1).norm(), 1e-12);
    double smallest = HUGE_VAL;
    for (int m = 1; m <= 64; ++m) smallest = std::min(smallest, lifting.square(m));
    const double norm = certify::TransferLifting<2>(mesh, facet, degree, pieces).norm();
    EXPECT_NEAR(norm, std::sqrt(smallest), 1e-10 * norm);
    for (const int m : {1, 2, 5})
      for (const double s : {0.03, 0.111, 0.47, 0.93})
      {
        constexpr double step = 1e-6;
        const Point<2> x = lifting.point(s, 0.3);
        Point<2> divergence = Point<2>::Zero();
        for (int a = 0; a < 2; ++a)
        {
          const Point<2> shift = step * Point<2>::Unit(a);
          divergence += (lifting.at(x + shift, m) - lifting.at(x - shift, m)).col(a) / (2 * step);
        }
        EXPECT_LE(divergence.norm(), 1e-6 * (1 + lifting.at(x, m).norm()));
      }
    for (const int other : {1, 2})
    {
      const Point<2> normal = mesh::facet_geometry(mesh, facet.cell, other).normal;
      for (const double z : {0.1, 0.6})
        EXPECT_LE((lifting.at(other == 2 ? 0.0 : 1.0, z, 3) * normal).norm(), 1e-10);
    }
  }
}

template <class T>
class TransferLiftingTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(TransferLiftingTest, Dimensions);

/// (tau, grad v)_T = (r, v)_F, v a random polynomial of degree p + 1: what adding tau changes of
/// ||grad v||^2. As r is orthogonal to those of degree p, v is a power of an affine function.
TYPED_TEST(TransferLiftingTest, HasTheTractionForGradients)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int round = 0; round < 24; ++round)
  {
    SCOPED_TRACE(round);
    const int degree = 1 + round % 4;
    const mesh::Mesh<dim> mesh = random_cell<dim>(random);
    const mesh::BoundaryFacet facet = first_facet(mesh);
    const auto pieces = random_pieces<dim>(degree, 2 + round % 3, round % 2, random);
    const certify::TransferLifting<dim> lifting(mesh, facet, degree, pieces);
    const mesh::CellMap<dim> cell = mesh::cell_map(mesh, 0);
    const auto direction = Point<dim>::NullaryExpr([&] { return value(random); }).eval();
    const auto slope = Point<dim>::NullaryExpr([&] { return value(random); }).eval();
    const auto affine = [&](const Point<dim>& xhat) { return slope.dot(cell(xhat)); };
    const double change = lifting.change(
        [&](const Point<dim>& xhat) -> Tensor<dim>
        { return (degree + 1) * std::pow(affine(xhat), degree) * direction * slope.transpose(); });

    // (q - Pi_F q, v)_F = (q, v - Pi_F v)_F
    const int n = fem::polynomial_dimension(dim - 1, degree);
    const double det = mesh::facet_geometry(mesh, facet.cell, facet.local).det();
    const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * degree + 1);
    std::vector<double> theta(n);
    const auto v = [&](const Point<dim - 1>& s)
    { return std::pow(affine(mesh::facet_to_cell<dim>(facet.local, s)), degree + 1); };
    std::vector<double> projection(n);
    for (int q = 0; q < rule.size(); ++q)
    {
      fem::orthonormal_values<dim - 1>(degree, rule.points[q], theta);
      for (int i = 0; i < n; ++i) projection[i] += rule.weights[q] * theta[i] * v(rule.points[q]);
    }
    double expected = 0;
    for (const TractionPiece<dim>& piece : pieces)
      for (int q = 0; q < rule.size(); ++q)
      {
        const Point<dim - 1> s = fem::point_in<dim - 1>(piece.part, rule.points[q]);
        fem::orthonormal_values<dim - 1>(degree, s, theta);
        double rest = v(s);
        for (int i = 0; i < n; ++i) rest -= projection[i] * theta[i];
        fem::orthonormal_values<dim - 1>(degree, rule.points[q], theta);
        for (int i = 0; i < n; ++i)
          expected += det * fem::fraction<dim - 1>(piece.part) * rule.weights[q] * rest * theta[i] *
                      piece.coefficients[i].dot(direction);
      }
    const double norm = lifting.norm();
    EXPECT_GT(std::abs(expected), 1e-6 * norm);
    EXPECT_NEAR((change - norm * norm) / 2, expected, 1e-11 * norm);
  }
}

}  // namespace

}  // namespace tribound::test
