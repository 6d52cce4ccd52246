#pragma once

/// @file holds.h
/// Which rigid motions the condition on a facet holds.

#include <vector>

#include "tribound/contact/nitsche/rigid_parts.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// Where displacement conditions are asked: at the vertices; with a spring, whose stiffness may vanish at
/// vertices and not between them, at the points of the rule that integrates data for p = 1.
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

/// Calls visit(R) for matrices R with a column for each mode, such that the condition stops no motion with
/// coefficients z if R z = 0 for all of them.
template <int dim, class Visit>
void for_each_hold(const problem::BoundaryCondition<dim>& condition, const mesh::Mesh<dim>& mesh,
                   const mesh::BoundaryFacet& facet, const RigidModes<dim>& modes, const Visit& visit)
{
  if (condition.rigid) return visit(fixed_motions(*condition.rigid, modes));
  const Point<dim> normal = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
  for (const Point<dim>& x : holding_points(condition, mesh, facet))
    visit(Eigen::MatrixXd(condition.held(x, normal) * modes.at(x)));
}

}  // namespace tribound::contact
