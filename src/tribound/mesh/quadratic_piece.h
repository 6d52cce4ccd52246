#pragma once

/// @file quadratic_piece.h
/// The distance of a point from a part of a second-order facet: bounds, convexity, minimum, subdivision.

#include <array>

#include "tribound/base/types.h"
#include "tribound/mesh/quadratic_facets.h"

namespace tribound::mesh
{

/// A part of a facet X seen from a point x: D(l) = X(l) - x = sum_ij l_i l_j control[i][j], a Bezier simplex
/// of degree 2 in the barycentric coordinates l of the part.
template <int dim>
struct QuadraticPiece
{
  using Barycentric = std::array<double, dim>;

  std::array<Barycentric, dim> corners;  ///< in the coordinates of the facet
  std::array<std::array<Point<dim>, dim>, dim> control;

  /// The whole facet with these nodes (QuadraticFacets::nodes).
  QuadraticPiece(const std::array<Point<dim>, n_facet_nodes<dim>>& nodes, const Point<dim>& x);

  /// D(l, m), the symmetric bilinear form with D(l, l) = D(l).
  [[nodiscard]] Point<dim> polar(const Barycentric& l, const Barycentric& m) const;
  /// l in the coordinates of the facet.
  [[nodiscard]] Barycentric place(const Barycentric& l) const;

  /// Contains D on the part.
  [[nodiscard]] BoundingBox<dim> box() const;
  /// A lower bound of |D|^2 on the part: the least of its Bernstein coefficients, which converges from below
  /// with the square of the part's size.
  [[nodiscard]] double lower_bound() const;
  /// Whether |D|^2 is certain to be convex on the part: all Bernstein coefficients of its Hessian are
  /// positive semidefinite.
  [[nodiscard]] bool is_convex() const;
  /// Where |D|^2 is least, in the coordinates of the part; certain if is_convex(). Coordinates on the
  /// boundary are exactly 0.
  [[nodiscard]] Barycentric minimiser() const;

  static constexpr int n_children = dim == 2 ? 2 : 4;
  /// The parts cut at the middles of its edges.
  [[nodiscard]] std::array<QuadraticPiece, n_children> children() const;

 private:
  static constexpr int n_coefficients = dim == 2 ? 5 : 15;

  QuadraticPiece() = default;

  void find_coefficients();
  /// The coefficient of |D|^2 with these corners, in any order.
  [[nodiscard]] double coefficient(int i, int j, int k, int l) const;
  [[nodiscard]] double minimiser_on_edge(int from, int to) const;
  [[nodiscard]] Barycentric minimiser_inside() const;
  [[nodiscard]] std::array<Point<dim>, dim - 1> tangents(const Barycentric& l) const;
  [[nodiscard]] QuadraticPiece child(const std::array<Barycentric, dim>& vertices) const;

  std::array<double, n_coefficients> coefficients_;
};

}  // namespace tribound::mesh
