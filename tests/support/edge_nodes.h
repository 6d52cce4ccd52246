#pragma once

/// @file edge_nodes.h
/// Meshes of order 2: nodes on the edges of boundary facets.

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "tribound/mesh/mesh.h"

namespace tribound::test
{

/// The mesh with nodes at place(middle of the edge) on the edges of the facets of one group.
template <int dim, class Place>
mesh::MeshData<dim> with_edge_nodes(mesh::MeshData<dim> data, int tag, Place place)
{
  std::set<std::array<Index, 2>> edges;
  for (const mesh::TaggedFacet<dim>& facet : data.facets)
    for (const auto& [i, j] : mesh::local_edges<dim - 1>)
      if (facet.tag == tag)
        edges.insert(
            {std::min(facet.vertices[i], facet.vertices[j]), std::max(facet.vertices[i], facet.vertices[j])});
  for (const auto& ends : edges)
    data.edge_nodes.push_back(
        {ends, place(Point<dim>((data.vertices[ends[0]] + data.vertices[ends[1]]) / 2))});
  return data;
}

}  // namespace tribound::test
