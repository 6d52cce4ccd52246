#pragma once

/// @file simplex_map.h
/// The map from reference coordinates to the points of a cell, a facet or a part of a facet.

#include <algorithm>
#include <array>
#include <cstddef>

#include "tribound/base/types.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

/// x = origin + J s maps the reference k-simplex onto a cell or facet.
template <int k, int dim>
struct SimplexMap
{
  Point<dim> origin;
  Eigen::Matrix<double, dim, k> jacobian;
  double measure;

  [[nodiscard]] Point<dim> operator()(const Point<k>& s) const { return origin + jacobian * s; }
};

/// The coordinates of points one after the other, as enclosures take them.
template <std::size_t n, int dim>
[[nodiscard]] std::array<double, n * dim> flat_coordinates(const std::array<Point<dim>, n>& points)
{
  std::array<double, n * dim> result;
  for (std::size_t i = 0; i < n; ++i) std::ranges::copy(points[i], result.begin() + i * dim);
  return result;
}

/// Those of the corners of a part of a simplex.
template <int k, int dim>
[[nodiscard]] std::array<double, (k + 1) * dim> corner_coordinates(const SimplexMap<k, dim>& map,
                                                                   const fem::Part<k>& part)
{
  std::array<Point<dim>, k + 1> corners;
  std::ranges::transform(part, corners.begin(), map);
  return flat_coordinates(corners);
}

/// The maps of a cell and of a boundary facet.
template <int dim>
[[nodiscard]] SimplexMap<dim, dim> simplex_map(const mesh::Mesh<dim>& mesh, Index cell)
{
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, cell);
  return {map.origin, map.jacobian, map.measure()};
}

template <int dim>
[[nodiscard]] SimplexMap<dim - 1, dim> simplex_map(const mesh::Mesh<dim>& mesh,
                                                   const mesh::BoundaryFacet& facet)
{
  const mesh::FacetMap<dim> map = mesh::facet_map(mesh, facet.cell, facet.local);
  return {map.origin, map.jacobian, mesh::facet_geometry(mesh, facet.cell, facet.local).measure};
}

}  // namespace tribound::contact
