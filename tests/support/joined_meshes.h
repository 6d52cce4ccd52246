#pragma once

/// @file joined_meshes.h
/// Meshes with several vertices in one place: cut open along joints, bodies that touch.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "support/meshes.h"
#include "tribound/mesh/mesh.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/verify.h"

namespace tribound::test
{

/// Gives every group of cells around a vertex that is connected through facets not in `opened` a vertex of
/// its own.
template <int dim, class Opened>
void cut_open(mesh::MeshData<dim>& data, const Opened& opened)
{
  const auto topology = mesh::build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  const auto cells = data.cells;
  const auto n_vertices = static_cast<Index>(data.vertices.size());
  for (Index v = 0; v < n_vertices; ++v)
  {
    std::set<Index> left(topology.vertex_cells.begin() + topology.vertex_cells_begin[v],
                         topology.vertex_cells.begin() + topology.vertex_cells_begin[v + 1]);
    for (bool is_first = true; !left.empty(); is_first = false)
    {
      const Index name = is_first ? v : static_cast<Index>(data.vertices.size());
      if (!is_first) data.vertices.push_back(data.vertices[v]);
      std::vector<Index> group = {*left.begin()};
      left.erase(left.begin());
      for (std::size_t k = 0; k < group.size(); ++k)
      {
        std::ranges::replace(data.cells[group[k]], v, name);
        for (int i = 0; i <= dim; ++i)
        {
          const Index facet = topology.cell_facets[group[k]][i];
          if (cells[group[k]][i] == v || opened(topology.facets[facet])) continue;
          for (const Index other : topology.facet_cells[facet])
            if (left.erase(other) > 0) group.push_back(other);
        }
      }
    }
  }
  data.facets.clear();
}

/// Two joints that cross, the second of which ends inside.
template <int dim>
mesh::MeshData<dim> crossing_joints()
{
  mesh::MeshData<dim> data = block<dim>({8, 6}, {6, 4, 2});
  const auto points = data.vertices;
  cut_open(data,
           [&](const std::array<Index, dim>& facet)
           {
             const auto all = [&](const auto& is) { return std::ranges::all_of(facet, is); };
             return all([&](Index v) { return std::abs(points[v][0] - 1) < 1e-9; }) ||
                    all([&](Index v) { return std::abs(points[v][1] - 0.5) < 1e-9 && points[v][0] > 0.3; });
           });
  EXPECT_GT(data.vertices.size(), points.size());
  return data;
}

/// Two boxes that touch, with as many cells along the contact or not.
template <int dim>
mesh::MeshData<dim> touching_boxes(int n_above)
{
  mesh::MeshData<dim> data = block<dim>({4, 2}, {4, 2, 2});
  mesh::MeshData<dim> above = block<dim>({n_above, 3}, {n_above, 2, n_above / 2});
  double top = 0;
  for (const Point<dim>& x : data.vertices) top = std::max(top, x[1]);
  const auto n = static_cast<Index>(data.vertices.size());
  for (Point<dim> x : above.vertices)
  {
    x[1] += top;
    data.vertices.push_back(x);
  }
  for (mesh::Cell<dim> cell : above.cells)
  {
    for (Index& v : cell) v += n;
    data.cells.push_back(cell);
  }
  data.regions.resize(data.cells.size(), 0);
  data.facets.clear();
  return data;
}

/// The cells of a mesh, which need not be one that Mesh takes.
template <int dim>
std::vector<mesh::CellRecord<dim>> all_records(const mesh::MeshData<dim>& data)
{
  const auto topology = mesh::build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  return mesh::first_records<dim>(data, mesh::find_boundary(data, topology));
}

}  // namespace tribound::test
