#pragma once

/// @file transfer_losses.h
/// r and rho of the lifting, at the points of a rule on the facet.

#include <span>
#include <vector>

#include "tribound/certify/bound/transfer.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

/// F in its cell, and Pi_F q.
template <int dim>
class LoadedFacet
{
 public:
  LoadedFacet(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree,
              std::span<const TractionPiece<dim>> pieces);

  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] double det() const { return geometry_.det(); }
  [[nodiscard]] double diameter() const { return geometry_.diameter; }
  [[nodiscard]] const Point<dim>& normal() const { return geometry_.normal; }
  /// Column j is the edge from vertex 0 to vertex j + 1.
  [[nodiscard]] const Eigen::Matrix<double, dim, dim - 1>& edges() const { return map_.jacobian; }
  /// xi - a_F.
  [[nodiscard]] Point<dim> from_foot(const Point<dim - 1>& s) const { return map_(s) - foot_; }
  /// The traction of a piece at a point in its own coordinates.
  [[nodiscard]] Point<dim> traction(const TractionPiece<dim>& piece, const Point<dim - 1>& s) const
  {
    return value(piece.coefficients, s);
  }
  /// Pi_F q.
  [[nodiscard]] Point<dim> projected(const Point<dim - 1>& s) const { return value(projection_, s); }

 private:
  /// sum_i c_i theta_i(s).
  [[nodiscard]] Point<dim> value(std::span<const Point<dim>> coefficients, const Point<dim - 1>& s) const;
  void project(std::span<const TractionPiece<dim>> pieces);

  int degree_;
  mutable std::vector<double> theta_;  ///< working space
  mesh::FacetMap<dim> map_;
  mesh::FacetGeometry<dim> geometry_;
  double height_;
  Point<dim> foot_;
  std::vector<Point<dim>> projection_;
};

/// Uses a rule that is exact for products of any two of r, moved and rho. In 3D empty without a
/// triangulation, or if rounding spoils rho.
[[nodiscard]] std::vector<TransferLoss<2>> transfer_losses(const LoadedFacet<2>& facet,
                                                           std::span<const TractionPiece<2>> pieces);
[[nodiscard]] std::vector<TransferLoss<3>> transfer_losses(const LoadedFacet<3>& facet,
                                                           std::span<const TractionPiece<3>> pieces);

}  // namespace tribound::certify
