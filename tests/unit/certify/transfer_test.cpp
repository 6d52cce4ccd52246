/// @file transfer_test.cpp
/// The lifting of what a contact traction loses between meshes: against the field itself, and against the
/// supremum that it bounds.

#include "tribound/certify/bound/transfer.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/dimensions.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::test
{

namespace
{

using certify::TractionPiece;

constexpr int facet_number = 0;  ///< in the cell

/// The reference cell with its vertices moved.
template <int dim>
mesh::Mesh<dim> random_cell(std::mt19937& random)
{
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  mesh::MeshData<dim> data;
  auto x = fem::reference_simplex<dim>();
  for (Point<dim>& vertex : x) vertex += Point<dim>::NullaryExpr([&] { return shift(random); });
  data.vertices.assign(x.begin(), x.end());
  data.cells.emplace_back();
  for (int i = 0; i <= dim; ++i) data.cells[0][i] = i;
  data.regions = {0};
  data.region_names = {"cell"};
  return mesh::Mesh<dim>(std::move(data));
}

template <int dim>
mesh::BoundaryFacet first_facet(const mesh::Mesh<dim>& mesh)
{
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.local == facet_number) return facet;
  return {};
}

template <int dim>
TractionPiece<dim> random_traction(const fem::Part<dim - 1>& part, int degree, std::mt19937& random)
{
  std::uniform_real_distribution<double> value(-1, 1);
  TractionPiece<dim> piece{part, {}};
  for (int i = 0; i < fem::polynomial_dimension(dim - 1, degree); ++i)
    piece.coefficients.push_back(Point<dim>::NullaryExpr([&] { return value(random); }));
  return piece;
}

/// Parts of the facet with random tractions, cut at random and numbered either way; `left_out` of them are
/// not covered.
template <int dim>
std::vector<TractionPiece<dim>> random_pieces(int degree, int n_cuts, int left_out, std::mt19937& random)
{
  std::vector<fem::Part<dim - 1>> parts = {fem::reference_simplex<dim - 1>()};
  std::uniform_real_distribution<double> share(0.2, 0.8);
  for (int n = 0; n < n_cuts; ++n)
  {
    const std::size_t k = random() % parts.size();
    const int i = static_cast<int>(random() % dim);
    const int j = (i + 1) % dim;
    const double t = share(random);
    const auto halves =
        fem::split<dim - 1>(parts[k], i, j, Point<dim - 1>((1 - t) * parts[k][i] + t * parts[k][j]));
    parts[k] = halves[0];
    parts.push_back(halves[1]);
  }
  std::ranges::shuffle(parts, random);
  parts.resize(parts.size() - left_out);
  std::vector<TractionPiece<dim>> pieces;
  for (fem::Part<dim - 1>& part : parts)
  {
    std::ranges::shuffle(part, random);
    pieces.push_back(random_traction<dim>(part, degree, random));
  }
  return pieces;
}

/// The supremum of (r, v)_F / ||grad v||_T over polynomials of degree `richness`, row by row.
template <int dim>
double supremum(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                const std::vector<TractionPiece<dim>>& pieces, int richness)
{
  const int n = fem::polynomial_dimension(dim, richness);
  const int n_facet = fem::polynomial_dimension(dim - 1, degree);
  std::vector<double> phi(n);
  std::vector<double> theta(n_facet);
  std::vector<Point<dim>> gradients(n);
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, facet.cell);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  const fem::Quadrature<dim> in_cell = fem::quadrature<dim>(2 * richness);
  for (int q = 0; q < in_cell.size(); ++q)
  {
    fem::orthonormal_gradients<dim>(richness, in_cell.points[q], phi, gradients);
    Eigen::MatrixXd g(dim, n);
    for (int i = 0; i < n; ++i) g.col(i) = map.inverse_transpose * gradients[i];
    a += in_cell.weights[q] * map.det * (g.transpose() * g);
  }
  const double det = mesh::facet_geometry(mesh, facet.cell, facet.local).det();
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(richness + degree);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, dim);              // (q, phi)_F
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(n_facet, dim);  // of q on the reference facet
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n_facet);   // (theta, phi)_F
  const auto at = [&](const Point<dim - 1>& s)
  {
    fem::orthonormal_values<dim>(richness, mesh::facet_to_cell<dim>(facet.local, s), phi);
    fem::orthonormal_values<dim - 1>(degree, s, theta);
  };
  const auto phi_vector = [&] { return Eigen::Map<const Eigen::VectorXd>(phi.data(), n); };
  const auto theta_vector = [&] { return Eigen::Map<const Eigen::VectorXd>(theta.data(), n_facet); };
  for (const TractionPiece<dim>& piece : pieces)
    for (int q = 0; q < rule.size(); ++q)
    {
      fem::orthonormal_values<dim - 1>(degree, rule.points[q], theta);
      Point<dim> t = Point<dim>::Zero();
      for (int i = 0; i < n_facet; ++i) t += theta[i] * piece.coefficients[i];
      at(fem::point_in<dim - 1>(piece.part, rule.points[q]));
      const double weight = fem::fraction<dim - 1>(piece.part) * rule.weights[q];
      b += weight * det * phi_vector() * t.transpose();
      moments += weight * theta_vector() * t.transpose();
    }
  for (int q = 0; q < rule.size(); ++q)
  {
    at(rule.points[q]);
    products += rule.weights[q] * det * phi_vector() * theta_vector().transpose();
  }
  b -= products * moments;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse(a);  // constants are its kernel
  return std::sqrt((b.transpose() * inverse.solve(b)).trace());
}

template <class T>
class TransferTest : public ::testing::Test
{
};
TYPED_TEST_SUITE(TransferTest, Dimensions);

TYPED_TEST(TransferTest, BoundsTheSupremum)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(1);
  double largest = 0;
  for (int round = 0; round < (dim == 2 ? 40 : 16); ++round)
  {
    SCOPED_TRACE(round);
    const int degree = 1 + round % 4;
    const mesh::Mesh<dim> mesh = random_cell<dim>(random);
    const mesh::BoundaryFacet facet = first_facet(mesh);
    const auto pieces = random_pieces<dim>(degree, 2 + round % 3, round % 2, random);
    const double norm = certify::transfer_norm<dim>(mesh, facet, degree, pieces);
    const double below = supremum<dim>(mesh, facet, degree, pieces, dim == 2 ? 14 : 8);
    EXPECT_GE(norm, below);
    largest = std::max(largest, norm / below);
  }
  EXPECT_LE(largest, dim == 2 ? 2 : 12);  // a guard against lost factors; a supremum over polynomials is less
}

/// Nothing is said about a part, or that it carries no traction.
TYPED_TEST(TransferTest, TakesWhatIsNotCoveredForFree)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(4);
  for (const int degree : {1, 2, 3, 4})
  {
    const mesh::Mesh<dim> mesh = random_cell<dim>(random);
    std::vector<TractionPiece<dim>> pieces = random_pieces<dim>(degree, 4, 0, random);
    for (const std::size_t k : {0, 1}) std::ranges::fill(pieces[k].coefficients, Point<dim>::Zero());
    const double norm = certify::transfer_norm<dim>(mesh, first_facet(mesh), degree, pieces);
    pieces.erase(pieces.begin(), pieces.begin() + 2);
    EXPECT_GT(norm, 0);
    EXPECT_NEAR(certify::transfer_norm<dim>(mesh, first_facet(mesh), degree, pieces), norm, 1e-12 * norm);
  }
}

/// Polynomials of degree p on the whole facet lose nothing, however they are cut.
TYPED_TEST(TransferTest, IsZeroForPolynomialsOfTheFacet)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(2);
  for (const int degree : {1, 2, 3, 4})
  {
    const mesh::Mesh<dim> mesh = random_cell<dim>(random);
    const mesh::BoundaryFacet facet = first_facet(mesh);
    std::vector<TractionPiece<dim>> pieces = random_pieces<dim>(degree, 0, 0, random);
    EXPECT_LE(certify::transfer_norm<dim>(mesh, facet, degree, pieces), 1e-13);
    const TractionPiece<dim> whole = pieces[0];
    pieces = random_pieces<dim>(degree, 3, 0, random);
    const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * degree);
    std::vector<double> theta(whole.coefficients.size());
    for (TractionPiece<dim>& piece : pieces)  // the same polynomial in the coordinates of the part
    {
      std::ranges::fill(piece.coefficients, Point<dim>::Zero());
      for (int q = 0; q < rule.size(); ++q)
      {
        Point<dim - 1> s = fem::point_in<dim - 1>(piece.part, rule.points[q]);
        if constexpr (dim == 2)
          s = (s - whole.part[0]) / (whole.part[1] - whole.part[0])[0];
        else
        {
          Eigen::Matrix2d edges;
          edges << whole.part[1] - whole.part[0], whole.part[2] - whole.part[0];
          s = edges.inverse() * (s - whole.part[0]);
        }
        fem::orthonormal_values<dim - 1>(degree, s, theta);
        Point<dim> t = Point<dim>::Zero();
        for (std::size_t i = 0; i < theta.size(); ++i) t += theta[i] * whole.coefficients[i];
        fem::orthonormal_values<dim - 1>(degree, rule.points[q], theta);
        for (std::size_t i = 0; i < theta.size(); ++i)
          piece.coefficients[i] += rule.weights[q] * theta[i] * t;
      }
    }
    EXPECT_LE(certify::transfer_norm<dim>(mesh, facet, degree, pieces), 1e-12);
  }
}

/// In 3D the formula, with p = 1: the projection by monomials, the foot of the apex by least squares.
TEST(Transfer, IsTheClosedFormIn3D)
{
  std::mt19937 random(5);
  const fem::Quadrature<2> rule = fem::quadrature<2>(4);
  for (int round = 0; round < 5; ++round)
  {
    const mesh::Mesh<3> mesh = random_cell<3>(random);
    const mesh::BoundaryFacet facet = first_facet(mesh);
    const auto pieces = random_pieces<3>(1, 3, 0, random);
    const auto [x0, x1, x2] =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), 0));
    const Point<3> apex = mesh.vertices()[mesh.cell(facet.cell)[0]];
    Eigen::Matrix<double, 3, 2> edges;
    edges << x1 - x0, x2 - x0;
    const Eigen::Vector2d foot = edges.colPivHouseholderQr().solve(apex - x0);
    const double height = (apex - x0 - edges * foot).norm();
    const double double_area = mesh::cross(x1 - x0, x2 - x0).norm();
    std::vector<double> theta(3);
    // visit(weight on the facet, (1, s, t), q)
    const auto at_points = [&](const auto& visit)
    {
      for (const TractionPiece<3>& piece : pieces)
        for (int q = 0; q < rule.size(); ++q)
        {
          fem::orthonormal_values<2>(1, rule.points[q], theta);
          const Point<2> s = fem::point_in<2>(piece.part, rule.points[q]);
          visit(double_area * fem::fraction<2>(piece.part) * rule.weights[q], Eigen::Vector3d(1, s[0], s[1]),
                Point<3>(theta[0] * piece.coefficients[0] + theta[1] * piece.coefficients[1] +
                         theta[2] * piece.coefficients[2]));
        }
    };
    Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    at_points(
        [&](double weight, const Eigen::Vector3d& monomials, const Point<3>& t)
        {
          gram += weight * monomials * monomials.transpose();
          moments += weight * monomials * t.transpose();
        });
    const Eigen::Matrix3d projection = gram.inverse() * moments;
    double plain = 0;
    double weighted = 0;
    at_points(
        [&](double weight, const Eigen::Vector3d& monomials, const Point<3>& t)
        {
          const double square = (t - projection.transpose() * monomials).squaredNorm();
          plain += weight * square;
          weighted += weight * square * (edges * (monomials.tail<2>() - foot)).squaredNorm();
        });
    const double diameter = std::max({(x1 - x0).norm(), (x2 - x0).norm(), (x2 - x1).norm()});
    double smallest = HUGE_VAL;
    for (int m = 1; m <= 64; ++m)
    {
      const double sum = std::sqrt(weighted) + m * diameter / std::acos(-1.0) * std::sqrt(plain);
      smallest = std::min(smallest, height / (2 * m - 1) * (plain + sum * sum / (height * height)));
    }
    EXPECT_NEAR(certify::transfer_norm<3>(mesh, facet, 1, pieces), std::sqrt(smallest), 1e-12);
  }
}

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
TEST(Transfer, IsTheNormOfALifting)
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
    const double norm = certify::transfer_norm<2>(mesh, facet, degree, pieces);
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

}  // namespace

}  // namespace tribound::test
