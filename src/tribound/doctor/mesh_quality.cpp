#include "tribound/doctor/mesh_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tribound/mesh/geometry.h"

namespace tribound::doctor
{

namespace
{

template <int dim>
Point<dim> centroid(const mesh::Mesh<dim>& mesh, Index cell)
{
  Point<dim> sum = Point<dim>::Zero();
  for (const Index v : mesh.cell(cell)) sum += mesh.vertex(v);
  return sum / (dim + 1);
}

/// The angles between facets of the cell, in degrees: smallest and largest.
template <int dim>
std::array<double, 2> extreme_angles(const mesh::Mesh<dim>& mesh, Index cell)
{
  std::array<Point<dim>, dim + 1> normals;
  for (int f = 0; f <= dim; ++f) normals[f] = mesh::facet_geometry(mesh, cell, f).normal;
  std::array<double, 2> extreme = {180, 0};
  for (int f = 0; f <= dim; ++f)
    for (int g = f + 1; g <= dim; ++g)
    {
      // pi minus the angle between the outward normals
      const double angle =
          std::acos(std::clamp(-normals[f].dot(normals[g]), -1.0, 1.0)) * 180 / std::numbers::pi;
      extreme = {std::min(extreme[0], angle), std::max(extreme[1], angle)};
    }
  return extreme;
}

}  // namespace

template <int dim>
double aspect_ratio(const mesh::Mesh<dim>& mesh, Index cell)
{
  const double regular = 2 * std::sqrt(dim == 2 ? 3.0 : 6.0);
  double surface = 0;
  for (int f = 0; f <= dim; ++f) surface += mesh::facet_geometry(mesh, cell, f).measure;
  const double inradius = dim * mesh::cell_map(mesh, cell).measure() / surface;
  return mesh::cell_diameter(mesh, cell) / (regular * inradius);
}

template <int dim>
MeshQuality mesh_quality(const mesh::Mesh<dim>& mesh)
{
  MeshQuality quality;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const auto [smallest, largest] = extreme_angles(mesh, c);
    if (smallest < quality.smallest_angle)
    {
      quality.smallest_angle = smallest;
      quality.smallest_angle_at = place<dim>(centroid(mesh, c));
    }
    if (largest > quality.largest_angle)
    {
      quality.largest_angle = largest;
      quality.largest_angle_at = place<dim>(centroid(mesh, c));
    }
    if (const double aspect = aspect_ratio(mesh, c); aspect > quality.largest_aspect)
    {
      quality.largest_aspect = aspect;
      quality.largest_aspect_at = place<dim>(centroid(mesh, c));
    }
    const double h = mesh::cell_diameter(mesh, c);
    quality.smallest_cell = std::min(quality.smallest_cell, h);
    quality.largest_cell = std::max(quality.largest_cell, h);
  }
  return quality;
}

template double aspect_ratio(const mesh::Mesh<2>&, Index);
template double aspect_ratio(const mesh::Mesh<3>&, Index);
template MeshQuality mesh_quality(const mesh::Mesh<2>&);
template MeshQuality mesh_quality(const mesh::Mesh<3>&);

}  // namespace tribound::doctor
