#pragma once

/// @file geometry.h
/// Affine geometry of simplices: reference map, measures, diameters, normals. Inline, since the loops over
/// cells of assembly call these.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "tribound/base/types.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// n!: the reference n-simplex has the measure 1 / n!.
template <int n>
inline constexpr int factorial = n* factorial<n - 1>;
template <>
inline constexpr int factorial<0> = 1;

/// The map x = x_0 + J xhat from the reference simplex {xhat >= 0, sum <= 1} onto a cell.
template <int dim>
struct CellMap
{
  Point<dim> origin;              ///< x_0
  Tensor<dim> jacobian;           ///< J; column j is x_{j+1} - x_0
  Tensor<dim> inverse_transpose;  ///< J^{-T}: grad = J^{-T} grad_hat
  double det;                     ///< det J = dim! |T| > 0

  [[nodiscard]] Point<dim> operator()(const Point<dim>& xhat) const { return origin + jacobian * xhat; }
  /// |T|.
  [[nodiscard]] double measure() const { return det / factorial<dim>; }
  /// grad lambda_i of the barycentric coordinates.
  [[nodiscard]] std::array<Point<dim>, dim + 1> barycentric_gradients() const
  {
    std::array<Point<dim>, dim + 1> gradients;
    gradients[0] = -inverse_transpose.rowwise().sum();
    for (int i = 0; i < dim; ++i) gradients[i + 1] = inverse_transpose.col(i);
    return gradients;
  }
};

/// The map x = x_0 + J s from the reference facet onto a facet, from its own vertices alone. A coordinate
/// that they share is that of every point, to the last bit, wherever the opposite vertex is.
template <int dim>
struct FacetMap
{
  Point<dim> origin;                             ///< x_0
  Eigen::Matrix<double, dim, dim - 1> jacobian;  ///< J; column j is x_{j+1} - x_0

  [[nodiscard]] Point<dim> operator()(const Point<dim - 1>& s) const { return origin + jacobian * s; }
};

template <int dim>
struct FacetGeometry
{
  Point<dim> normal;  ///< outward unit normal of the cell
  double measure;     ///< length or area |F|
  double diameter;    ///< h_F: the longest edge

  /// |F| / |reference facet|.
  [[nodiscard]] double det() const { return factorial<dim - 1> * measure; }
};

/// The smallest box with edges along the axes that contains the points added.
template <int dim>
struct BoundingBox
{
  Point<dim> lower = Point<dim>::Constant(std::numeric_limits<double>::infinity());
  Point<dim> upper = -lower;

  void add(const Point<dim>& x)
  {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }

  [[nodiscard]] double longest_edge() const { return (upper - lower).maxCoeff(); }
  [[nodiscard]] double diagonal() const { return (upper - lower).norm(); }
};

template <int dim>
[[nodiscard]] BoundingBox<dim> bounding_box(std::span<const Point<dim>> points)
{
  BoundingBox<dim> box;
  for (const Point<dim>& x : points) box.add(x);
  return box;
}

/// The box around a mesh, on several ranks around all its parts. They call it together.
template <int dim>
[[nodiscard]] BoundingBox<dim> box_around(const Mesh<dim>& mesh)
{
  BoundingBox<dim> box = bounding_box(mesh.vertices());
  std::array<double, 2 * dim> ends;  // all to be made as large as can be
  for (int i = 0; i < dim; ++i)
  {
    ends[i] = -box.lower[i];
    ends[dim + i] = box.upper[i];
  }
  mesh.ranks().max(std::span(ends));
  for (int i = 0; i < dim; ++i)
  {
    box.lower[i] = -ends[i];
    box.upper[i] = ends[dim + i];
  }
  return box;
}

/// a x b.
[[nodiscard]] inline Point<3> cross(const Point<3>& a, const Point<3>& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// cof J = det(J) J^{-T}; its columns are orthogonal to the other columns of J.
template <int dim>
[[nodiscard]] Tensor<dim> cofactor(const Tensor<dim>& jacobian)
{
  Tensor<dim> result;
  if constexpr (dim == 2)
    result << jacobian(1, 1), -jacobian(1, 0), -jacobian(0, 1), jacobian(0, 0);
  else
    for (int j = 0; j < 3; ++j) result.col(j) = cross(jacobian.col((j + 1) % 3), jacobian.col((j + 2) % 3));
  return result;
}

/// Whether x comes before y: compares the first coordinate in which they differ by more than `zero`. A choice
/// by this order does not depend on the numbering of the mesh.
template <int dim>
[[nodiscard]] bool comes_before(const Point<dim>& x, const Point<dim>& y, double zero = 0)
{
  for (int i = 0; i < dim; ++i)
    if (std::abs(x[i] - y[i]) > zero) return x[i] < y[i];
  return false;
}

/// The longest distance between two of the points.
template <int dim, std::size_t n>
[[nodiscard]] double diameter(const std::array<Point<dim>, n>& points)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      largest = std::max(largest, (points[j] - points[i]).squaredNorm());
  return std::sqrt(largest);
}

/// The positions of the given vertices.
template <int dim, std::size_t n>
[[nodiscard]] std::array<Point<dim>, n> points_of(std::span<const Point<dim>> vertices,
                                                  const std::array<Index, n>& numbers)
{
  std::array<Point<dim>, n> points;
  for (std::size_t i = 0; i < n; ++i) points[i] = vertices[numbers[i]];
  return points;
}

/// det (x_1 - x_0, ..., x_dim - x_0) = dim! times the signed measure of the simplex.
template <int dim>
[[nodiscard]] double determinant(const std::array<Point<dim>, dim + 1>& points)
{
  const Point<dim> a = points[1] - points[0];
  const Point<dim> b = points[2] - points[0];
  if constexpr (dim == 2)
    return a[0] * b[1] - a[1] * b[0];
  else
    return a.dot(cross(b, points[3] - points[0]));
}

template <int dim>
[[nodiscard]] CellMap<dim> cell_map(const Mesh<dim>& mesh, Index cell)
{
  const auto points = points_of(mesh.vertices(), mesh.cell(cell));
  CellMap<dim> map;
  map.origin = points[0];
  for (int j = 0; j < dim; ++j) map.jacobian.col(j) = points[j + 1] - points[0];
  const Tensor<dim> cof = cofactor<dim>(map.jacobian);
  map.det = map.jacobian.col(0).dot(cof.col(0));
  map.inverse_transpose = cof / map.det;
  return map;
}

/// The map of a facet with these vertices in ascending local order, that of facet_to_cell().
template <int dim>
[[nodiscard]] FacetMap<dim> facet_map(const std::array<Point<dim>, dim>& points)
{
  FacetMap<dim> map;
  map.origin = points[0];
  for (int j = 0; j < dim - 1; ++j) map.jacobian.col(j) = points[j + 1] - points[0];
  return map;
}

/// The map of facet `local` of `cell`.
template <int dim>
[[nodiscard]] FacetMap<dim> facet_map(const Mesh<dim>& mesh, Index cell, int local)
{
  return facet_map<dim>(points_of(mesh.vertices(), facet_vertices(mesh.cell(cell), local)));
}

/// h_T: the longest edge.
template <int dim>
[[nodiscard]] double cell_diameter(const Mesh<dim>& mesh, Index cell)
{
  return diameter(points_of(mesh.vertices(), mesh.cell(cell)));
}

/// Local facet `local`, seen from its cell, with these vertices in ascending local order.
template <int dim>
[[nodiscard]] FacetGeometry<dim> facet_geometry(const std::array<Point<dim>, dim>& points, int local)
{
  const Point<dim> edge = points[1] - points[0];
  Point<dim> normal;  // outward for even `local`: the facet's vertices in ascending local order turn with it
  if constexpr (dim == 2)
    normal << edge[1], -edge[0];
  else
    normal = cross(edge, points[2] - points[0]);
  const double length = normal.norm();
  return {(local % 2 == 0 ? normal : -normal) / length, dim == 2 ? length : 0.5 * length, diameter(points)};
}

/// Local facet `local` of `cell`, seen from that cell.
template <int dim>
[[nodiscard]] FacetGeometry<dim> facet_geometry(const Mesh<dim>& mesh, Index cell, int local)
{
  return facet_geometry<dim>(points_of(mesh.vertices(), facet_vertices(mesh.cell(cell), local)), local);
}

/// The reference coordinates in the cell of the point `s` of the reference facet: the facet's vertices are
/// taken in ascending local order, s = 0 is the first of them.
template <int dim>
[[nodiscard]] Point<dim> facet_to_cell(int local, const Point<dim - 1>& s)
{
  assert(local >= 0 && local <= dim);
  Point<dim> xhat = Point<dim>::Zero();
  const int first = local == 0 ? 1 : 0;
  if (first > 0) xhat[first - 1] = 1.0 - s.sum();
  for (int k = 0, j = first + 1; k < dim - 1; ++k, ++j)
  {
    if (j == local) ++j;
    xhat[j - 1] = s[k];
  }
  return xhat;
}

/// The inverse of facet_to_cell.
template <int dim>
[[nodiscard]] Point<dim - 1> cell_to_facet(int local, const Point<dim>& xhat)
{
  Point<dim - 1> s;
  for (int k = 0; k < dim - 1; ++k) s[k] = xhat[k + 1 < local ? k : k + 1];
  return s;
}

}  // namespace tribound::mesh
