#include <algorithm>
#include <cstdint>

#include "tribound/mesh/marked_cell.h"
#include "tribound/mesh/partition.h"

namespace tribound::mesh
{

template <int dim>
std::vector<CellTags<dim>> cell_tags(std::size_t n_cells, std::span<const BoundaryFacet> boundary)
{
  CellTags<dim> inside;
  inside.fill(facet_inside);
  std::vector<CellTags<dim>> tags(n_cells, inside);
  for (const auto& [cell, local, tag] : boundary) tags[cell][local] = tag;
  return tags;
}

namespace
{

/// The records of cells first, ..., last - 1. `region`: the region of a cell.
template <int dim, class Region>
std::vector<CellRecord<dim>> first_records(std::span<const Point<dim>> points,
                                           std::span<const Cell<dim>> cells,
                                           std::span<const std::uint8_t> types, const Region& region,
                                           std::span<const BoundaryFacet> boundary, Index first, Index last)
{
  std::vector<BoundaryFacet> facets;  // in which `first` is cell 0
  for (BoundaryFacet facet : boundary)
    if (facet.cell >= first && facet.cell < last)
    {
      facet.cell -= first;
      facets.push_back(facet);
    }
  const std::vector<CellTags<dim>> tags = cell_tags<dim>(last - first, facets);
  std::vector<CellRecord<dim>> records(last - first);
  for (Index c = first; c < last; ++c)
  {
    const MarkedCell<dim> marked = marked_cell<dim>(points, cells, types, c);
    CellRecord<dim>& record = records[c - first];
    record.name.root = c;
    record.region = region(c);
    record.bisection_type = marked.type;
    for (int i = 0; i <= dim; ++i)
    {
      const Index v = marked.vertices[i];
      record.vertices[i] = vertex_name<dim>(points[v], v);
      record.tags[i] = tags[c - first][std::ranges::find(cells[c], v) - cells[c].begin()];
    }
  }
  return records;
}

}  // namespace

template <int dim>
std::vector<CellRecord<dim>> first_records(const MeshData<dim>& data, std::span<const BoundaryFacet> boundary)
{
  return first_records<dim>(
      data.vertices, data.cells, data.bisection_types, [&](Index c) { return data.regions[c]; }, boundary, 0,
      static_cast<Index>(data.cells.size()));
}

template <int dim>
std::vector<CellRecord<dim>> first_records(const Mesh<dim>& mesh, Index first, Index last)
{
  return first_records<dim>(
      mesh.vertices(), mesh.cells(), mesh.bisection_types(), [&](Index c) { return mesh.region(c); },
      mesh.boundary(), first, last);
}

template std::vector<CellTags<2>> cell_tags<2>(std::size_t, std::span<const BoundaryFacet>);
template std::vector<CellRecord<2>> first_records(const MeshData<2>&, std::span<const BoundaryFacet>);
template std::vector<CellRecord<2>> first_records(const Mesh<2>&, Index, Index);
template std::vector<CellTags<3>> cell_tags<3>(std::size_t, std::span<const BoundaryFacet>);
template std::vector<CellRecord<3>> first_records(const MeshData<3>&, std::span<const BoundaryFacet>);
template std::vector<CellRecord<3>> first_records(const Mesh<3>&, Index, Index);

}  // namespace tribound::mesh
