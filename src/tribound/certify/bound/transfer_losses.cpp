#include "tribound/certify/bound/transfer_losses.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tribound/certify/bound/facet_cover.h"
#include "tribound/certify/bound/facet_flux.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

template <int dim>
LoadedFacet<dim>::LoadedFacet(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
                              std::span<const TractionPiece<dim>> pieces)
    : degree_(degree),
      theta_(fem::polynomial_dimension(dim - 1, degree)),
      map_(mesh::facet_map(mesh, facet.cell, facet.local)),
      geometry_(mesh::facet_geometry(mesh, facet.cell, facet.local))
{
  const Point<dim> apex = mesh.vertices()[mesh.cell(facet.cell)[facet.local]];
  height_ = geometry_.normal.dot(map_.origin - apex);
  foot_ = apex + height_ * geometry_.normal;
  project(pieces);
}

template <int dim>
Point<dim> LoadedFacet<dim>::value(std::span<const Point<dim>> coefficients, const Point<dim - 1>& s) const
{
  fem::orthonormal_values<dim - 1>(degree_, s, theta_);
  Point<dim> sum = Point<dim>::Zero();
  for (std::size_t i = 0; i < coefficients.size(); ++i) sum += theta_[i] * coefficients[i];
  return sum;
}

template <int dim>
void LoadedFacet<dim>::project(std::span<const TractionPiece<dim>> pieces)
{
  projection_.assign(theta_.size(), Point<dim>::Zero());
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * degree_);
  for (const TractionPiece<dim>& piece : pieces)
  {
    const double share = fem::fraction<dim - 1>(piece.part);
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> t = traction(piece, rule.points[q]);
      fem::orthonormal_values<dim - 1>(degree_, fem::point_in<dim - 1>(piece.part, rule.points[q]), theta_);
      for (std::size_t i = 0; i < theta_.size(); ++i)
        projection_[i] += share * rule.weights[q] * theta_[i] * t;
    }
  }
}

template class LoadedFacet<2>;
template class LoadedFacet<3>;

namespace
{

/// The ends of all parts, and those of the facet.
std::vector<double> ends_of(std::span<const TractionPiece<2>> pieces)
{
  std::vector<double> ends = {0, 1};
  for (const TractionPiece<2>& piece : pieces)
    for (const Point<1>& end : piece.part) ends.push_back(std::clamp(end[0], 0.0, 1.0));
  std::ranges::sort(ends);
  return ends;
}

/// q at s, in the interval with the given middle, on which it is a polynomial.
Point<2> sum_of_tractions(const LoadedFacet<2>& facet, std::span<const TractionPiece<2>> pieces,
                          double middle, double s)
{
  Point<2> sum = Point<2>::Zero();
  for (const TractionPiece<2>& piece : pieces)
  {
    const double first = piece.part[0][0];
    const double length = piece.part[1][0] - first;
    const double place = (middle - first) / length;
    if (place > 0 && place < 1) sum += facet.traction(piece, Point<1>((s - first) / length));
  }
  return sum;
}

/// A triangle of the cover, with the data to evaluate r there.
struct CoveredTriangle
{
  fem::Part<2> part;  ///< of the reference facet
  double det;         ///< of the map onto the facet from the reference triangle
  const TractionPiece<3>* piece;
  Eigen::Matrix2d to_piece;  ///< inverse of the edge matrix of its part

  [[nodiscard]] Point<3> loss(const LoadedFacet<3>& facet, const Point<2>& s) const
  {
    Point<3> r = -facet.projected(s);
    if (piece != nullptr) r += facet.traction(*piece, to_piece * (s - piece->part[0]));
    return r;
  }
};

std::vector<CoveredTriangle> covered_triangles(const LoadedFacet<3>& facet, const FacetCover& cover,
                                               std::span<const TractionPiece<3>> pieces)
{
  std::vector<CoveredTriangle> result;
  for (const FacetCover::Triangle& triangle : cover.triangles)
  {
    CoveredTriangle& next = result.emplace_back();
    for (int i = 0; i < 3; ++i) next.part[i] = cover.vertices[triangle.corners[i]];
    next.det = facet.det() * fem::fraction<2>(next.part);
    next.piece = triangle.part < 0 ? nullptr : &pieces[triangle.part];
    if (next.piece == nullptr) continue;
    const fem::Part<2>& part = next.piece->part;
    Eigen::Matrix2d edges;
    edges << part[1] - part[0], part[2] - part[0];
    next.to_piece = edges.inverse();
  }
  return result;
}

/// Orthonormal tangents in whose coordinates the facet keeps its orientation.
Eigen::Matrix<double, 3, 2> tangents(const LoadedFacet<3>& facet)
{
  Eigen::Matrix<double, 3, 2> result;
  result.col(0) = facet.edges().col(0).normalized();
  result.col(1) = mesh::cross(facet.normal(), result.col(0));
  if (result.col(1).dot(facet.edges().col(1)) < 0) result.col(1) *= -1;
  return result;
}

}  // namespace

std::vector<TransferLoss<2>> transfer_losses(const LoadedFacet<2>& facet,
                                             std::span<const TractionPiece<2>> pieces)
{
  const fem::Quadrature<1> rule = fem::quadrature<1>(2 * facet.degree() + 2);
  const std::vector<double> ends = ends_of(pieces);
  const Point<2> tangent = facet.edges().normalized();
  std::vector<TransferLoss<2>> result;
  Point<2> at_first = Point<2>::Zero();
  for (std::size_t k = 0; k + 1 < ends.size(); ++k)
  {
    const double first = ends[k];
    const double length = ends[k + 1] - first;
    const auto r = [&](double s) -> Point<2>
    { return sum_of_tractions(facet, pieces, first + length / 2, s) - facet.projected(Point<1>(s)); };
    const auto integral = [&](double to)
    {
      Point<2> sum = Point<2>::Zero();
      for (int q = 0; q < rule.size(); ++q)
        sum += rule.weights[q] * (to - first) * facet.det() * r(first + (to - first) * rule.points[q][0]);
      return sum;
    };
    for (int q = 0; q < rule.size(); ++q)
    {
      const double s = first + length * rule.points[q][0];
      result.push_back({Point<1>(s), length * facet.det() * rule.weights[q], r(s),
                        r(s) * facet.from_foot(Point<1>(s)).transpose(),
                        (at_first + integral(s)) * tangent.transpose()});
    }
    at_first += integral(ends[k + 1]);
  }
  return result;
}

std::vector<TransferLoss<3>> transfer_losses(const LoadedFacet<3>& facet,
                                             std::span<const TractionPiece<3>> pieces)
{
  std::vector<fem::Part<2>> parts;
  for (const TractionPiece<3>& piece : pieces) parts.push_back(piece.part);
  const std::optional<FacetCover> cover = conforming_cover(parts);
  if (!cover) return {};
  const Eigen::Matrix<double, 3, 2> frame = tangents(facet);
  std::vector<Point<2>> vertices;
  for (const Point<2>& s : cover->vertices) vertices.emplace_back(frame.transpose() * facet.edges() * s);
  const FacetFlux flux(*cover, vertices, facet.degree());

  const std::vector<CoveredTriangle> triangles = covered_triangles(facet, *cover, pieces);
  const fem::Quadrature<2> rule = fem::quadrature<2>(2 * facet.degree() + 2);
  const int n = fem::polynomial_dimension(2, facet.degree() + 1);
  const int n_moments = fem::polynomial_dimension(2, facet.degree());
  Eigen::MatrixXd values(n, rule.size());  // theta_i at the points
  for (int q = 0; q < rule.size(); ++q)
    fem::orthonormal_values<2>(facet.degree() + 1, rule.points[q],
                               std::span(values.col(q).data(), static_cast<std::size_t>(n)));

  std::vector<TransferLoss<3>> result;
  const auto n_triangles = static_cast<Eigen::Index>(triangles.size());
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(n_triangles * n_moments, 3);
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(n_triangles * 2 * n, 3);  // (xi - a_F) r
  for (Eigen::Index k = 0; k < n_triangles; ++k)
    for (int q = 0; q < rule.size(); ++q)
    {
      const CoveredTriangle& triangle = triangles[k];
      const Point<2> s = fem::point_in<2>(triangle.part, rule.points[q]);
      const Point<3> r = triangle.loss(facet, s);
      const Point<2> y = frame.transpose() * facet.from_foot(s);
      const double weight = std::sqrt(triangle.det) * rule.weights[q];
      moments.middleRows(k * n_moments, n_moments) += weight * values.col(q).head(n_moments) * r.transpose();
      for (int c = 0; c < 2; ++c)
        moved.middleRows((2 * k + c) * n, n) += weight * y[c] * values.col(q) * r.transpose();
      result.push_back({s, triangle.det * rule.weights[q], r, Tensor<3>::Zero(), Tensor<3>::Zero()});
    }
  const std::optional<Eigen::MatrixXd> rho = flux.with_divergence(moments);
  const std::optional<Eigen::MatrixXd> rest = flux.without_circulation(moved, moments.norm());
  if (!rho || !rest) return {};
  for (Eigen::Index k = 0; k < n_triangles; ++k)
    for (int q = 0; q < rule.size(); ++q)
    {
      const auto at_point = [&](const Eigen::MatrixXd& field) -> Tensor<3>
      {
        Eigen::Matrix<double, 3, 2> value;
        for (int c = 0; c < 2; ++c)
          value.col(c) =
              field.middleRows((2 * k + c) * n, n).transpose() * values.col(q) / std::sqrt(triangles[k].det);
        return value * frame.transpose();
      };
      TransferLoss<3>& loss = result[k * rule.size() + q];
      loss.moved = at_point(*rest);
      loss.rho = at_point(*rho);
    }
  return result;
}

}  // namespace tribound::certify
