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

/// `regions`: that of a cell.
template <int dim, class Region>
std::vector<CellRecord<dim>> first_records(std::span<const Point<dim>> points,
                                           std::span<const Cell<dim>> cells,
                                           std::span<const std::uint8_t> types, const Region& region,
                                           std::span<const BoundaryFacet> boundary)
{
  const std::vector<CellTags<dim>> tags = cell_tags<dim>(cells.size(), boundary);
  std::vector<CellRecord<dim>> records(cells.size());
  for (Index c = 0; c < static_cast<Index>(records.size()); ++c)
  {
    const MarkedCell<dim> marked = marked_cell<dim>(points, cells, types, c);
    CellRecord<dim>& record = records[c];
    record.name.root = c;
    record.region = region(c);
    record.bisection_type = marked.type;
    for (int i = 0; i <= dim; ++i)
    {
      const Index v = marked.vertices[i];
      record.vertices[i] = vertex_name<dim>(points[v], v);
      record.tags[i] = tags[c][std::ranges::find(cells[c], v) - cells[c].begin()];
    }
  }
  return records;
}

}  // namespace

template <int dim>
std::vector<CellRecord<dim>> first_records(const MeshData<dim>& data, std::span<const BoundaryFacet> boundary)
{
  return first_records<dim>(
      data.vertices, data.cells, data.bisection_types, [&](Index c) { return data.regions[c]; }, boundary);
}

template <int dim>
std::vector<CellRecord<dim>> first_records(const Mesh<dim>& mesh)
{
  return first_records<dim>(
      mesh.vertices(), mesh.cells(), mesh.bisection_types(), [&](Index c) { return mesh.region(c); },
      mesh.boundary());
}

template std::vector<CellTags<2>> cell_tags<2>(std::size_t, std::span<const BoundaryFacet>);
template std::vector<CellRecord<2>> first_records(const MeshData<2>&, std::span<const BoundaryFacet>);
template std::vector<CellRecord<2>> first_records(const Mesh<2>&);
template std::vector<CellTags<3>> cell_tags<3>(std::size_t, std::span<const BoundaryFacet>);
template std::vector<CellRecord<3>> first_records(const MeshData<3>&, std::span<const BoundaryFacet>);
template std::vector<CellRecord<3>> first_records(const Mesh<3>&);

}  // namespace tribound::mesh
