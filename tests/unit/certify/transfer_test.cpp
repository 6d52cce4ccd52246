/// @file transfer_test.cpp
/// What a contact traction loses between meshes: against the supremum that it bounds, and the closed form.

#include "tribound/certify/bound/transfer.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/dimensions.h"
#include "tribound/base/dense_factors.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"
#include "unit/certify/transfer_testing.h"

namespace tribound::test
{

namespace
{

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
  const Eigen::MatrixXd x = least_norm_solution(a, b);  // constants are the kernel of a
  return std::sqrt((b.transpose() * x).trace());
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
    const double norm = certify::TransferLifting<dim>(mesh, facet, degree, pieces).norm();
    const double below = supremum<dim>(mesh, facet, degree, pieces, dim == 2 ? 14 : 8);
    EXPECT_GE(norm, below);
    largest = std::max(largest, norm / below);
  }
  EXPECT_LE(largest, 2.5);  // a guard against lost factors; a supremum over polynomials is less
}

/// Nothing is said about a part, or that it carries no traction. In 3D the facet is then triangulated in
/// another way.
TYPED_TEST(TransferTest, TakesWhatIsNotCoveredForFree)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(4);
  for (const int degree : {1, 2, 3, 4})
  {
    const mesh::Mesh<dim> mesh = random_cell<dim>(random);
    std::vector<TractionPiece<dim>> pieces = random_pieces<dim>(degree, 4, 0, random);
    for (const std::size_t k : {0, 1}) std::ranges::fill(pieces[k].coefficients, Point<dim>::Zero());
    const certify::TransferLifting<dim> told(mesh, first_facet(mesh), degree, pieces);
    pieces.erase(pieces.begin(), pieces.begin() + 2);
    const certify::TransferLifting<dim> untold(mesh, first_facet(mesh), degree, pieces);
    EXPECT_GT(told.norm(), 0);
    EXPECT_NEAR(untold.norm(), told.norm(), (dim == 2 ? 1e-12 : 0.02) * told.norm());
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
    EXPECT_LE(certify::TransferLifting<dim>(mesh, facet, degree, pieces).norm(), 1e-13);
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
    EXPECT_LE(certify::TransferLifting<dim>(mesh, facet, degree, pieces).norm(), 1e-12);
  }
}

/// Where parts overlap by a little more than rounding, there is no triangulation.
TEST(Transfer, IsTheClosedFormWhereThereIsNoTriangulation)
{
  constexpr double j = 3.8317059702075123;  // first zero of the Bessel function J_1
  std::mt19937 random(5);
  for (const int degree : {1, 2, 3, 4})
  {
    const mesh::Mesh<3> mesh = random_cell<3>(random);
    auto pieces = random_pieces<3>(degree, 3, 0, random);
    const double regular = certify::TransferLifting<3>(mesh, first_facet(mesh), degree, pieces).norm();
    EXPECT_LT(regular, 0.9 * closed_form(mesh, first_facet(mesh), degree, pieces, j));
    pieces[0].part[0] += 1e-9 * (pieces[0].part[0] - pieces[0].part[1]);
    const certify::TransferLifting<3> lifting(mesh, first_facet(mesh), degree, pieces);
    const double expected = closed_form(mesh, first_facet(mesh), degree, pieces, j);
    EXPECT_NEAR(lifting.norm(), expected, 1e-9 * expected);
    EXPECT_EQ(lifting.change([](const Point<3>&) { return Tensor<3>::Identity(); }), HUGE_VAL);
  }
}

/// Parts with edges of 1 : 1000 and angles to match.
TEST(Transfer, BearsNarrowParts)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.2, 0.8);
  for (int round = 0; round < 12; ++round)
  {
    SCOPED_TRACE(round);
    const int degree = 1 + round % 4;
    const mesh::Mesh<3> mesh = random_cell<3>(random);
    std::vector<TractionPiece<3>> pieces;
    std::vector<fem::Part<2>> parts = {fem::reference_simplex<2>()};
    for (int n = 0; n < 6; ++n)
    {
      const std::size_t k = random() % parts.size();
      const int i = static_cast<int>(random() % 3);
      const int j = (i + 1) % 3;
      const double t = n % 2 == 1 ? 1e-3 : share(random);
      const auto halves = fem::split<2>(parts[k], i, j, Point<2>((1 - t) * parts[k][i] + t * parts[k][j]));
      parts[k] = halves[0];
      parts.push_back(halves[1]);
    }
    for (const fem::Part<2>& part : parts) pieces.push_back(random_traction<3>(part, degree, random));
    const certify::TransferLifting<3> lifting(mesh, first_facet(mesh), degree, pieces);
    EXPECT_LE(lifting.norm(), 0.6 * closed_form(mesh, first_facet(mesh), degree, pieces, 3.141592653589793));
    EXPECT_GE(lifting.norm(), supremum<3>(mesh, first_facet(mesh), degree, pieces, 6));
  }
}

}  // namespace

}  // namespace tribound::test
