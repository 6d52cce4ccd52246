#pragma once

/// @file mesh_quality.h
/// Shape and size of the cells.

#include <limits>

#include "tribound/doctor/place.h"
#include "tribound/mesh/mesh.h"

namespace tribound::doctor
{

struct MeshQuality
{
  double smallest_angle = 180;  ///< degrees: between two sides of a triangle, two faces of a tetrahedron
  Place smallest_angle_at;      ///< centroid of the cell
  double largest_angle = 0;
  Place largest_angle_at;
  double largest_aspect = 0;  ///< see aspect_ratio()
  Place largest_aspect_at;
  double smallest_cell = std::numeric_limits<double>::infinity();  ///< min h_T
  double largest_cell = 0;                                         ///< max h_T
};

/// Longest edge over inradius, scaled to 1 for the regular simplex: h / (c r) with c = 2 sqrt(3) in 2D and 2
/// sqrt(6) in 3D.
template <int dim>
[[nodiscard]] double aspect_ratio(const mesh::Mesh<dim>& mesh, Index cell);

template <int dim>
[[nodiscard]] MeshQuality mesh_quality(const mesh::Mesh<dim>& mesh);

}  // namespace tribound::doctor
