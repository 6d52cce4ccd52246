#pragma once

/// @file holding_points.h
/// Where conditions on a facet are asked which rigid motions they hold.

#include <vector>

#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// The vertices, where components are fixed; with a spring, whose stiffness may vanish at vertices and not
/// between them, the points of the rule that integrates data for p = 1.
template <int dim>
[[nodiscard]] std::vector<Point<dim>> holding_points(const problem::BoundaryCondition<dim>& condition,
                                                     const mesh::Mesh<dim>& mesh,
                                                     const mesh::BoundaryFacet& facet)
{
  std::vector<Point<dim>> points;
  if (condition.spring)
  {
    const SimplexMap<dim - 1, dim> map = simplex_map(mesh, facet);
    for (const Point<dim - 1>& s : fem::quadrature<dim - 1>(fem::data_quadrature_degree(1)).points)
      points.push_back(map(s));
  }
  else
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      points.push_back(mesh.vertex(v));
  return points;
}

}  // namespace tribound::contact
