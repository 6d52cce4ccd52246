#pragma once

/// @file body.h
/// The parts of a mesh that move independently of each other.

#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A part of the mesh that is connected through facets. Different bodies have no vertex in common.
template <int dim>
struct Body
{
  Point<dim> centre = Point<dim>::Zero();   ///< the mean of the vertices
  std::vector<int> regions;                 ///< ascending
  std::vector<Index> vertices;              ///< of the mesh
  std::vector<Index> nodes;                 ///< of the space
  std::vector<mesh::BoundaryFacet> facets;  ///< its part of the boundary
  std::vector<std::size_t> numbers;         ///< of these facets in Mesh::boundary()
  std::vector<Index> cells;
};

/// All bodies, by ascending number of their first cell.
template <int dim>
[[nodiscard]] std::vector<Body<dim>> find_bodies(const fem::LagrangeSpace<dim>& space);

/// `the body (region "steel")`; if there are several, `the body around (0.5, 1) (region "steel")`.
template <int dim>
[[nodiscard]] std::string describe(const Body<dim>& body, const problem::Problem<dim>& problem, bool several);

}  // namespace tribound::contact
