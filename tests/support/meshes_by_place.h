#pragma once

/// Meshes as sets of cells and facets, whatever their numbers.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::test
{

/// The name of a group, and the coordinates of the vertices, ascending.
using NamedPlaces = std::vector<std::pair<std::string, std::vector<std::vector<double>>>>;

template <int dim>
[[nodiscard]] NamedPlaces cells_by_place(const mesh::Mesh<dim>& mesh)
{
  NamedPlaces result;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    auto& cell = result.emplace_back(mesh.region_names()[mesh.region(c)], 0);
    for (const Index v : mesh.cell(c)) cell.second.emplace_back(mesh.vertex(v).begin(), mesh.vertex(v).end());
    std::ranges::sort(cell.second);
  }
  std::ranges::sort(result);
  return result;
}

template <int dim>
[[nodiscard]] NamedPlaces facets_by_place(const mesh::Mesh<dim>& mesh)
{
  NamedPlaces result;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    auto& corners = result.emplace_back(facet.tag < 0 ? "" : mesh.boundary_names()[facet.tag], 0);
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      corners.second.emplace_back(mesh.vertex(v).begin(), mesh.vertex(v).end());
    std::ranges::sort(corners.second);
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace tribound::test
