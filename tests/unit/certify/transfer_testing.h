#pragma once

/// @file transfer_testing.h
/// Random cells, and tractions on parts of one of their facets.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/transfer.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/mesh.h"

namespace tribound::test
{

using certify::TractionPiece;

inline constexpr int facet_number = 0;  ///< in the cell

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

/// The norm of a lifting in 3D whose rho is known by ||rho|| <= h_F / root ||r|| alone, of pieces that cover
/// the facet: the projection by monomials, the foot of the apex by least squares.
inline double closed_form(const mesh::Mesh<3>& mesh, const mesh::BoundaryFacet& facet, int degree,
                          const std::vector<TractionPiece<3>>& pieces, double root)
{
  const auto [x0, x1, x2] =
      mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
  const Point<3> apex = mesh.vertices()[mesh.cell(facet.cell)[facet.local]];
  Eigen::Matrix<double, 3, 2> edges;
  edges << x1 - x0, x2 - x0;
  const Eigen::Vector2d foot = PivotedQr(edges).solve(apex - x0);
  const double height = (apex - x0 - edges * foot).norm();
  const double double_area = mesh::cross(x1 - x0, x2 - x0).norm();
  const int n = fem::polynomial_dimension(2, degree);
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * degree + 2);
  const auto monomials = [&](const Point<2>& s)
  {
    Eigen::VectorXd values(n);
    int k = 0;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j) values[k++] = std::pow(s[0], i) * std::pow(s[1], j);
    return values;
  };
  std::vector<double> theta(n);
  // visit(weight on the facet, s, q)
  const auto at_points = [&](const auto& visit)
  {
    for (const TractionPiece<3>& piece : pieces)
      for (int q = 0; q < rule.size(); ++q)
      {
        fem::orthonormal_values<2>(degree, rule.points[q], theta);
        Point<3> t = Point<3>::Zero();
        for (int i = 0; i < n; ++i) t += theta[i] * piece.coefficients[i];
        visit(double_area * fem::fraction<2>(piece.part) * rule.weights[q],
              fem::point_in<2>(piece.part, rule.points[q]), t);
      }
  };
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  for (int q = 0; q < rule.size(); ++q)
    gram += double_area * rule.weights[q] * monomials(rule.points[q]) * monomials(rule.points[q]).transpose();
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(n, 3);
  at_points([&](double weight, const Point<2>& s, const Point<3>& t)
            { moments += weight * monomials(s) * t.transpose(); });
  const Eigen::MatrixXd projection = CholeskyFactors(gram).solve(moments);
  double plain = 0;
  double weighted = 0;
  at_points(
      [&](double weight, const Point<2>& s, const Point<3>& t)
      {
        const double square = (t - projection.transpose() * monomials(s)).squaredNorm();
        plain += weight * square;
        weighted += weight * square * (edges * (s - foot)).squaredNorm();
      });
  const double diameter = std::max({(x1 - x0).norm(), (x2 - x0).norm(), (x2 - x1).norm()});
  double smallest = HUGE_VAL;
  for (int m = 1; m <= 64; ++m)
  {
    const double sum = std::sqrt(weighted) + m * diameter / root * std::sqrt(plain);
    smallest = std::min(smallest, height / (2 * m - 1) * (plain + sum * sum / (height * height)));
  }
  return std::sqrt(smallest);
}

}  // namespace tribound::test
