#pragma once

/// @file bisect_checks.h
/// Properties of every bisected mesh, checked by coordinates rather than its own topology.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tribound/mesh/bisect.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound::testing_mesh
{

/// The coordinates of a simplex's vertices in lexicographic order: its identity, independent of numbering.
template <int dim, std::size_t n>
std::array<std::array<double, dim>, n> coordinates(const mesh::Mesh<dim>& mesh,
                                                   const std::array<Index, n>& vertices)
{
  std::array<std::array<double, dim>, n> points;
  for (std::size_t i = 0; i < n; ++i) std::copy_n(mesh.vertex(vertices[i]).data(), dim, points[i].begin());
  std::ranges::sort(points);
  return points;
}

/// All cells by their coordinates, sorted.
template <int dim>
std::vector<std::array<std::array<double, dim>, dim + 1>> cells_by_coordinates(const mesh::Mesh<dim>& mesh)
{
  std::vector<std::array<std::array<double, dim>, dim + 1>> cells;
  for (const auto& cell : mesh.cells()) cells.push_back(coordinates(mesh, cell));
  std::ranges::sort(cells);
  return cells;
}

/// Facets with one cell cover exactly the boundary; facets with two cells have one on each side. Facets and
/// vertices are identified by coordinates.
template <int dim>
void expect_conforming(const mesh::Mesh<dim>& mesh, double boundary)
{
  std::vector<std::array<double, dim>> places;
  for (const Point<dim>& x : mesh.vertices())
  {
    places.emplace_back();
    std::copy_n(x.data(), dim, places.back().begin());
  }
  std::ranges::sort(places);
  EXPECT_EQ(std::ranges::adjacent_find(places), places.end()) << "two vertices at one place";

  struct Side
  {
    std::array<std::array<double, dim>, dim> facet;
    Point<dim> normal;
    double measure;
  };
  std::vector<Side> sides;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int i = 0; i <= dim; ++i)
    {
      const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, c, i);
      sides.push_back(
          {coordinates(mesh, mesh::facet_vertices(mesh.cell(c), i)), geometry.normal, geometry.measure});
    }
  std::ranges::sort(sides, {}, &Side::facet);
  double single = 0;
  for (auto first = sides.begin(); first != sides.end();)
  {
    const auto last = std::ranges::find_if(first, sides.end(),
                                           [&](const Side& side) { return side.facet != first->facet; });
    ASSERT_LE(last - first, 2);
    if (last - first == 2)
    {
      ASSERT_LT((first->normal + (first + 1)->normal).norm(), 1e-9);
    }
    else
      single += first->measure;
    first = last;
  }
  EXPECT_NEAR(single, boundary, 1e-12 * boundary);
}

template <int dim>
double whole_boundary(const mesh::Mesh<dim>& mesh)
{
  double sum = 0;
  for (int tag = -1; tag < static_cast<int>(mesh.boundary_names().size()); ++tag)
    sum += boundary_measure(mesh, tag);
  return sum;
}

template <int dim>
std::vector<double> region_volumes(const mesh::Mesh<dim>& mesh)
{
  std::vector<double> volumes(mesh.region_names().size(), 0.0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    volumes[mesh.region(c)] += mesh::cell_map(mesh, c).det / (dim == 2 ? 2 : 6);
  return volumes;
}

/// Names, volumes of regions and measures of boundary groups are those of the original mesh.
template <int dim>
void expect_same_parts(const mesh::Mesh<dim>& mesh, const mesh::Mesh<dim>& original)
{
  EXPECT_TRUE(std::ranges::equal(mesh.region_names(), original.region_names()));
  EXPECT_TRUE(std::ranges::equal(mesh.boundary_names(), original.boundary_names()));
  EXPECT_EQ(mesh.source().file, original.source().file);
  const std::vector<double> volumes = region_volumes(mesh);
  const std::vector<double> expected = region_volumes(original);
  for (std::size_t r = 0; r < volumes.size(); ++r) EXPECT_NEAR(volumes[r], expected[r], 1e-12 * expected[r]);
  for (int tag = -1; tag < static_cast<int>(original.boundary_names().size()); ++tag)
    EXPECT_NEAR(boundary_measure(mesh, tag), boundary_measure(original, tag), 1e-12) << tag;
}

/// Every cell lies in its parent and has the parent's region; the children fill the parent.
template <int dim>
void expect_right_parents(const mesh::Bisected<dim>& bisected, const mesh::Mesh<dim>& original)
{
  ASSERT_EQ(bisected.parent.size(), static_cast<std::size_t>(bisected.mesh.n_cells()));
  EXPECT_TRUE(std::ranges::is_sorted(bisected.parent));
  std::vector<double> filled(original.n_cells(), 0.0);
  for (Index c = 0; c < bisected.mesh.n_cells(); ++c)
  {
    const Index parent = bisected.parent[c];
    const mesh::CellMap<dim> map = mesh::cell_map(original, parent);
    filled[parent] += mesh::cell_map(bisected.mesh, c).det / map.det;
    ASSERT_EQ(bisected.mesh.region(c), original.region(parent));
    for (const Index v : bisected.mesh.cell(c))
    {
      const Point<dim> xhat = map.inverse_transpose.transpose() * (bisected.mesh.vertex(v) - map.origin);
      ASSERT_GE(xhat.minCoeff(), -1e-11);
      ASSERT_LE(xhat.sum(), 1 + 1e-11);
    }
  }
  for (const double share : filled) ASSERT_NEAR(share, 1.0, 1e-11);
}

/// The vertices are those of the original mesh and midpoints of older ones. The original mesh is added to its
/// own ancestors.
template <int dim>
void expect_right_ancestry(const mesh::Mesh<dim>& bisected, const mesh::Mesh<dim>& original)
{
  const mesh::Ancestry& ancestry = bisected.ancestry();
  std::vector<Index> sizes = original.ancestry().n_vertices;
  sizes.push_back(original.n_vertices());
  ASSERT_EQ(ancestry.n_vertices, sizes);
  ASSERT_TRUE(std::ranges::equal(original.vertices(), bisected.vertices().first(original.n_vertices())));
  const Index first = sizes.front();
  ASSERT_EQ(ancestry.halved_edges.size(), static_cast<std::size_t>(bisected.n_vertices() - first));
  for (Index v = first; v < bisected.n_vertices(); ++v)
  {
    const auto [a, b] = ancestry.halved_edges[v - first];
    ASSERT_LT(std::max(a, b), v);
    ASSERT_EQ(bisected.vertex(v), Point<dim>(0.5 * (bisected.vertex(a) + bisected.vertex(b))));
  }
}

/// Boundary groups stay in place: facets of the bisected mesh lie in facets of the original one with the same
/// tag. A facet on the boundary has one parent cell, one facet of which contains it.
template <int dim>
void expect_tags_in_place(const mesh::Bisected<dim>& bisected, const mesh::Mesh<dim>& original)
{
  std::vector<std::array<int, dim + 1>> tags(original.n_cells());
  for (auto& cell_tags : tags) cell_tags.fill(-2);  // inside the domain
  for (const auto& [cell, local, tag] : original.boundary()) tags[cell][local] = tag;
  for (const auto& [cell, local, tag] : bisected.mesh.boundary())
  {
    const Index parent = bisected.parent[cell];
    const mesh::CellMap<dim> map = mesh::cell_map(original, parent);
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : mesh::facet_vertices(bisected.mesh.cell(cell), local))
      centre += bisected.mesh.vertex(v) / dim;
    const Point<dim> xhat = map.inverse_transpose.transpose() * (centre - map.origin);
    std::array<double, dim + 1> barycentric{1 - xhat.sum()};
    std::copy_n(xhat.data(), dim, barycentric.begin() + 1);
    const auto zero = std::ranges::min_element(barycentric, {}, [](double x) { return std::abs(x); });
    EXPECT_NEAR(*zero, 0, 1e-11);
    ASSERT_EQ(tag, tags[parent][zero - barycentric.begin()]);
  }
}

}  // namespace tribound::testing_mesh
