#include "tribound/mesh/first_facets.h"

#include <array>
#include <cstdint>
#include <unordered_map>

#include "tribound/mesh/partition.h"

namespace tribound::mesh
{

template <int dim>
FirstFacets first_facets(const MeshData<dim>& data, std::span<const BoundaryFacet> boundary)
{
  FirstFacets result;
  std::vector<Index> number(data.vertices.size(), -1);
  Index n_vertices = 0;
  for (const auto& [cell, local, tag] : boundary)
  {
    if (tag < 0) continue;
    result.tags.push_back(tag);
    for (const Index v : facet_vertices(data.cells[cell], local))
    {
      if (number[v] < 0)
      {
        number[v] = n_vertices++;
        result.points.insert(result.points.end(), data.vertices[v].begin(), data.vertices[v].end());
      }
      result.vertices.push_back(number[v]);
    }
  }
  return result;
}

namespace
{

/// A facet as it travels between ranks.
template <int dim>
struct NamedFacet
{
  std::int32_t tag;
  std::array<VertexName<dim>, dim> vertices;
};

}  // namespace

template <int dim>
FirstFacets first_facets(const Ranks& ranks, std::span<const CellRecord<dim>> cells)
{
  std::vector<NamedFacet<dim>> facets;
  for (const CellRecord<dim>& cell : cells)
    for (int i = 0; i <= dim; ++i)
      if (cell.tags[i] >= 0) facets.push_back({cell.tags[i], facet_vertices(cell.vertices, i)});
  facets = ranks.gather(std::span<const NamedFacet<dim>>(facets));
  FirstFacets result;
  std::unordered_map<VertexName<dim>, Index, VertexHash<dim>> numbers;
  for (const auto& [tag, vertices] : facets)
  {
    result.tags.push_back(tag);
    for (const VertexName<dim>& vertex : vertices)
    {
      const auto [it, is_new] = numbers.try_emplace(vertex, static_cast<Index>(numbers.size()));
      if (is_new) result.points.insert(result.points.end(), vertex.position.begin(), vertex.position.end());
      result.vertices.push_back(it->second);
    }
  }
  ranks.copy_from_first(result.tags);
  ranks.copy_from_first(result.vertices);
  ranks.copy_from_first(result.points);
  return result;
}

template FirstFacets first_facets(const MeshData<2>&, std::span<const BoundaryFacet>);
template FirstFacets first_facets(const MeshData<3>&, std::span<const BoundaryFacet>);
template FirstFacets first_facets(const Ranks&, std::span<const CellRecord<2>>);
template FirstFacets first_facets(const Ranks&, std::span<const CellRecord<3>>);

}  // namespace tribound::mesh
