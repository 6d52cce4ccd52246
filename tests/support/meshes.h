#pragma once

/// @file meshes.h
/// Meshes for tests: boxes moved, mapped, renumbered and put together.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tribound/mesh/box.h"
#include "tribound/mesh/mesh.h"

namespace tribound::test
{

/// The names of the sides of a box.
template <int dim>
inline constexpr std::array<const char*, 2 * static_cast<std::size_t>(dim)> side_names = []
{
  if constexpr (dim == 2)
    return std::array{"left", "right", "bottom", "top"};
  else
    return std::array{"left", "right", "bottom", "top", "back", "front"};
}();

/// The structured box between two corners.
template <int dim>
mesh::MeshData<dim> box(const Point<dim>& lower, const Point<dim>& upper, const std::array<int, dim>& cells)
{
  return mesh::box_mesh<dim>({.lower = {lower.data(), lower.data() + dim},
                              .upper = {upper.data(), upper.data() + dim},
                              .cells = {cells.begin(), cells.end()},
                              .where = {}});
}

/// The block (0, 2) x (0, 1) [x (0, 1)].
template <int dim>
mesh::MeshData<dim> block(const std::array<int, dim>& cells)
{
  Point<dim> upper = Point<dim>::Ones();
  upper[0] = 2;
  return box<dim>(Point<dim>::Zero(), upper, cells);
}

/// The block of either dimension.
template <int dim>
mesh::MeshData<dim> block(const std::array<int, 2>& cells_2d, const std::array<int, 3>& cells_3d)
{
  if constexpr (dim == 2)
    return block<2>(cells_2d);
  else
    return block<3>(cells_3d);
}

/// The mesh with every vertex x at map(x).
template <int dim, class Map>
mesh::MeshData<dim> mapped(mesh::MeshData<dim> data, Map map)
{
  for (Point<dim>& x : data.vertices) x = map(x);
  return data;
}

/// A rotation that leaves no side of a box parallel to an axis.
template <int dim>
Tensor<dim> rotation()
{
  Tensor<2> plane;
  plane << 0.8, -0.6, 0.6, 0.8;
  if constexpr (dim == 2) return plane;
  Tensor<dim> about_z = Tensor<dim>::Identity();
  Tensor<dim> about_x = Tensor<dim>::Identity();
  about_z.topLeftCorner(2, 2) = plane;
  about_x.bottomRightCorner(2, 2) = plane;
  return about_x * about_z;
}

/// The same mesh with vertices and cells in random order and the vertices of each cell in a random order of
/// positive orientation.
template <int dim>
mesh::MeshData<dim> renumbered(mesh::MeshData<dim> data, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<Index> number(data.vertices.size());  // new number of each vertex
  std::iota(number.begin(), number.end(), 0);
  std::ranges::shuffle(number, random);
  std::vector<Point<dim>> vertices(data.vertices.size());
  for (std::size_t v = 0; v < number.size(); ++v) vertices[number[v]] = data.vertices[v];
  data.vertices = std::move(vertices);
  for (mesh::TaggedFacet<dim>& facet : data.facets)
    for (Index& v : facet.vertices) v = number[v];

  std::vector<std::size_t> order(data.cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::shuffle(order, random);
  std::vector<mesh::Cell<dim>> cells;
  std::vector<int> regions;
  for (const std::size_t c : order)
  {
    mesh::Cell<dim> cell = data.cells[c];
    for (Index& v : cell) v = number[v];
    for (int i = 0, n = static_cast<int>(random() % 12); i < n; ++i)  // three-cycles keep the orientation
    {
      const std::size_t first = dim == 2 ? 0 : random() % 2;
      std::rotate(cell.begin() + first, cell.begin() + first + 1, cell.begin() + first + 3);
    }
    cells.push_back(cell);
    regions.push_back(data.regions[c]);
  }
  data.cells = std::move(cells);
  data.regions = std::move(regions);
  return data;
}

/// The mesh with bent sides and cells that all differ, numbered at random.
template <int dim>
mesh::MeshData<dim> distorted(mesh::MeshData<dim> data, unsigned seed)
{
  const auto bend = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    for (int a = 0; a < dim; ++a) y[a] += 0.06 * std::sin(3 * x[(a + 1) % dim] + a) + 0.03 * x[a] * x[a];
    return y;
  };
  return renumbered(mapped(std::move(data), bend), seed);
}

/// Both meshes side by side, not connected; boundaries and regions of `b` get names with `suffix` behind.
template <int dim>
mesh::MeshData<dim> side_by_side(mesh::MeshData<dim> a, const mesh::MeshData<dim>& b,
                                 const std::string& suffix)
{
  const auto first_vertex = static_cast<Index>(a.vertices.size());
  const auto first_region = static_cast<int>(a.region_names.size());
  const auto first_boundary = static_cast<int>(a.boundary_names.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (mesh::Cell<dim> cell : b.cells)
  {
    for (Index& v : cell) v += first_vertex;
    a.cells.push_back(cell);
  }
  for (const int region : b.regions) a.regions.push_back(region + first_region);
  for (mesh::TaggedFacet<dim> facet : b.facets)
  {
    for (Index& v : facet.vertices) v += first_vertex;
    facet.tag += first_boundary;
    a.facets.push_back(facet);
  }
  for (auto node : b.edge_nodes)
  {
    for (Index& v : node.ends) v += first_vertex;
    a.edge_nodes.push_back(node);
  }
  for (const std::string& name : b.region_names) a.region_names.push_back(name + suffix);
  for (const std::string& name : b.boundary_names) a.boundary_names.push_back(name + suffix);
  return a;
}

/// The mesh without the cells whose centre is in a region, and without the vertices that only they have.
template <int dim, class Inside>
mesh::MeshData<dim> without(mesh::MeshData<dim> data, const Inside& inside)
{
  std::vector<mesh::Cell<dim>> kept;
  for (const mesh::Cell<dim>& cell : data.cells)
  {
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : cell) centre += data.vertices[v] / (dim + 1);
    if (!inside(centre)) kept.push_back(cell);
  }
  std::vector<Index> number(data.vertices.size(), -1);
  std::vector<Point<dim>> vertices;
  for (mesh::Cell<dim>& cell : kept)
    for (Index& v : cell)
    {
      if (number[v] < 0)
      {
        number[v] = static_cast<Index>(vertices.size());
        vertices.push_back(data.vertices[v]);
      }
      v = number[v];
    }
  std::set<std::set<Index>> facets;
  for (const mesh::Cell<dim>& cell : kept)
    for (int i = 0; i <= dim; ++i)
    {
      const auto facet = mesh::facet_vertices(cell, i);
      facets.emplace(facet.begin(), facet.end());
    }
  std::erase_if(data.facets,
                [&](mesh::TaggedFacet<dim>& facet)
                {
                  for (Index& v : facet.vertices) v = number[v];
                  return !facets.contains(std::set<Index>(facet.vertices.begin(), facet.vertices.end()));
                });
  data.vertices = std::move(vertices);
  data.regions.assign(kept.size(), 0);
  data.cells = std::move(kept);
  return data;
}

}  // namespace tribound::test
