#pragma once

/// @file describe.h
/// How messages name the parts of a mesh.

#include <array>
#include <span>
#include <string>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// "(0.5, 1)".
[[nodiscard]] std::string describe_point(std::span<const double> x);

template <int dim>
[[nodiscard]] std::string describe(const Point<dim>& x)
{
  return describe_point({x.data(), dim});
}

/// "vertex 3 at (0.5, 1)".
template <int dim>
[[nodiscard]] std::string describe_vertex(const MeshData<dim>& data, Index v)
{
  return "vertex " + std::to_string(v) + " at " + describe(data.vertices[v]);
}

/// "(0, 0), (1, 0)": the positions of the given vertices.
template <int dim, std::size_t n>
[[nodiscard]] std::string describe_corners(const MeshData<dim>& data, const std::array<Index, n>& vertices)
{
  std::string text;
  for (const Index v : vertices) text += (text.empty() ? "" : ", ") + describe(data.vertices[v]);
  return text;
}

/// "edge (0, 0), (1, 0)" in 2D, "face (...), (...), (...)" in 3D.
template <int dim>
[[nodiscard]] std::string describe_facet(const MeshData<dim>& data, const std::array<Index, dim>& vertices)
{
  return (dim == 2 ? "edge " : "face ") + describe_corners(data, vertices);
}

/// "triangle 7 of region "steel" with corners (0, 0), (1, 0), (0, 1)".
template <int dim>
[[nodiscard]] std::string describe_cell(const MeshData<dim>& data, Index c)
{
  return (dim == 2 ? "triangle " : "tetrahedron ") + std::to_string(c) + " of region \"" +
         data.region_names[data.regions[c]] + "\" with corners " + describe_corners(data, data.cells[c]);
}

}  // namespace tribound::mesh
