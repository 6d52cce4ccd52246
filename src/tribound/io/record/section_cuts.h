#pragma once

/// @file section_cuts.h
/// What the planes of sections cut out of cells. Internal to sections.cpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tribound/fem/polynomials.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/io/record/sections.h"
#include "tribound/mesh/geometry.h"

namespace tribound::io
{

/// A facet of a part of a cell, in reference coordinates.
template <int dim>
using Piece = std::array<Point<dim>, dim>;

/// What a plane has of a cell.
template <int dim>
struct CellCut
{
  std::vector<Piece<dim>> on_plane{};
  std::vector<fem::Part<dim>> behind{};  ///< none where a facet of the cell is in the plane
};

inline constexpr double zero_height = 1e-12;  // of the diagonal of the box around the mesh

/// Distances of the vertices of cells from the plane, those at rounding level 0: the same for all cells of a
/// vertex, so that what they have of the plane fits together.
template <int dim>
class Plane
{
 public:
  Plane(const mesh::Mesh<dim>& mesh, const Section<dim>& section)
      : mesh_(mesh), section_(section), zero_(zero_height * mesh::box_around(mesh).diagonal())
  {
  }

  [[nodiscard]] CellCut<dim> cut(Index cell) const
  {
    std::array<double, dim + 1> heights;
    for (int i = 0; i <= dim; ++i)
    {
      const double height = (mesh_.vertex(mesh_.cell(cell)[i]) - section_.point).dot(section_.normal);
      heights[i] = std::abs(height) <= zero_ ? 0 : height;
    }
    const auto [lowest, highest] = std::ranges::minmax(heights);
    const bool is_cut = lowest < 0 && highest > 0;
    const bool has_facet = lowest < 0 && highest == 0 && std::ranges::count(heights, 0.0) == dim;
    CellCut<dim> result;
    std::vector<fem::Part<dim>> parts;
    if (is_cut) fem::cut<dim>(fem::reference_simplex<dim>(), heights, 0, parts);
    if (has_facet) parts.push_back(fem::reference_simplex<dim>());
    for (const fem::Part<dim>& part : parts) add(part, heights, result);
    if (has_facet) result.behind.clear();
    return result;
  }

 private:
  /// The part, if it is behind the plane, and its facet in the plane.
  void add(const fem::Part<dim>& part, const std::array<double, dim + 1>& heights, CellCut<dim>& result) const
  {
    std::array<double, dim + 1> at;
    for (int i = 0; i <= dim; ++i)
    {
      const auto lambda = fem::barycentric<dim>(part[i]);
      double height = 0;
      for (int k = 0; k <= dim; ++k) height += lambda[k] * heights[k];
      at[i] = std::abs(height) <= zero_ / 2 ? 0 : height;  // a new corner is in the plane up to rounding
    }
    if (std::ranges::min(at) >= 0) return;
    result.behind.push_back(part);
    if (std::ranges::count(at, 0.0) != dim) return;
    Piece<dim>& piece = result.on_plane.emplace_back();
    for (int i = 0, k = 0; i <= dim; ++i)
      if (at[i] == 0) piece[k++] = part[i];
  }

  const mesh::Mesh<dim>& mesh_;
  const Section<dim>& section_;
  double zero_;
};

/// |piece| / |reference facet| in space.
template <int dim>
[[nodiscard]] double scale_of(const mesh::CellMap<dim>& map, const Piece<dim>& piece)
{
  const Point<dim> a = map.jacobian * (piece[1] - piece[0]);
  if constexpr (dim == 2)
    return a.norm();
  else
    return mesh::cross(a, map.jacobian * (piece[2] - piece[0])).norm();
}

/// Whether the section has what the plane cuts out of a cell.
template <int dim>
[[nodiscard]] bool is_within(const Section<dim>& section, const mesh::CellMap<dim>& map,
                             const CellCut<dim>& cut)
{
  if (!section.within) return true;
  Point<dim> sum = Point<dim>::Zero();
  double measure = 0;
  for (const Piece<dim>& piece : cut.on_plane)
  {
    const double scale = scale_of<dim>(map, piece);
    measure += scale;
    for (const Point<dim>& corner : piece) sum += scale / dim * map(corner);
  }
  return measure > 0 && (*section.within)(Point<dim>(sum / measure)) > 0;
}

/// Calls visit(cell, map, cut) for the own cells of the section.
template <int dim, class Visit>
void for_each_cut(const mesh::Mesh<dim>& mesh, const Section<dim>& section, const Visit& visit)
{
  const Plane<dim> plane(mesh, section);
  mesh.ranks().together(
      [&]
      {
        for (Index c = 0; c < mesh.n_owned_cells(); ++c)
        {
          const CellCut<dim> cut = plane.cut(c);
          if (cut.on_plane.empty()) continue;
          const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
          if (is_within(section, map, cut)) visit(c, map, cut);
        }
      });
}

}  // namespace tribound::io
