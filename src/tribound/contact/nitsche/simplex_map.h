#pragma once

/// @file simplex_map.h
/// The map from reference coordinates to the points of a cell, a facet or a part of a facet.

#include "tribound/base/types.h"
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
