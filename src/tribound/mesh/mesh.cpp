#include "tribound/mesh/mesh.h"

#include <algorithm>
#include <utility>

#include "tribound/mesh/interfaces.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

/// The arrays of a part of a mesh.
template <int dim>
MeshData<dim> data_of(MeshPart<dim>& part, MeshLabels&& labels)
{
  MeshData<dim> data{std::move(labels)};
  data.vertices.reserve(part.partition.vertices.size());
  for (const VertexName<dim>& name : part.partition.vertices) data.vertices.push_back(name.point());
  data.cells = std::move(part.corners);
  data.regions.reserve(part.cells.size());
  data.bisection_types.reserve(part.cells.size());
  for (const CellRecord<dim>& cell : part.cells)
  {
    data.regions.push_back(cell.region);
    data.bisection_types.push_back(static_cast<std::uint8_t>(cell.bisection_type));
  }
  return data;
}

}  // namespace

template <int dim>
Mesh<dim>::Mesh(MeshData<dim> data)
{
  check_arrays(data);
  check_shapes(data);
  Topology<dim> topology = build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  check_facets(data, topology);
  const Interfaces<dim> interfaces(data, topology);
  const std::vector<OuterFacet<dim>> outer = outer_facets(data, topology);
  check_conformity<dim>(data, outer, interfaces);
  if (data.bisection_types.empty())
    check_overlap<dim>(data, outer, interfaces);  // bisection keeps the domain
  boundary_ = find_boundary(data, topology);
  check_vertices(data, topology);
  if (!data.quadratic_facets) data.quadratic_facets = quadratic_facets<dim>(data, boundary_);  // the first
  n_owned_cells_ = static_cast<Index>(data.cells.size());
  n_owned_boundary_ = boundary_.size();
  take(std::move(data), std::move(topology));
}

template <int dim>
Mesh<dim>::Mesh(MeshPart<dim> part, MeshLabels labels)
{
  MeshData<dim> data = data_of(part, std::move(labels));
  auto partition = std::make_shared<const Partition<dim>>(std::move(part.partition));
  ranks_ = partition->ranks;
  n_owned_cells_ = partition->n_owned_cells;
  has_patch_ = partition->has_patch;
  partition_ = std::move(partition);
  if (!data.cells.empty()) check_arrays(data);  // there may be more ranks than cells
  check_shapes(data);
  Topology<dim> topology = build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  check_facets(data, topology);
  boundary_ = find_boundary<dim>(data, topology, part.cells, n_owned_cells_, has_patch_);
  n_owned_boundary_ = std::ranges::partition_point(boundary_, [this](const BoundaryFacet& facet)
                                                   { return facet.cell < n_owned_cells_; }) -
                      boundary_.begin();
  check_vertices(data, topology, has_patch_);
  take(std::move(data), std::move(topology));
}

template <int dim>
std::int64_t Mesh<dim>::n_global_cells() const
{
  return partition_ ? partition_->n_cells : n_cells();
}

template <int dim>
std::int64_t Mesh<dim>::n_global_vertices() const
{
  return partition_ ? partition_->n_vertices : n_vertices();
}

template <int dim>
void Mesh<dim>::take(MeshData<dim> data, Topology<dim> topology)
{
  vertices_ = std::move(data.vertices);
  cells_ = std::move(data.cells);
  regions_ = std::move(data.regions);
  labels_ = static_cast<MeshLabels&&>(data);
  bisection_types_ = std::move(data.bisection_types);
  ancestry_ = std::move(data.ancestry);
  topology_ = std::make_unique<const Topology<dim>>(std::move(topology));
}

template <int dim>
std::vector<std::size_t> facets_named(const Mesh<dim>& mesh, std::span<const std::string> names)
{
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < mesh.boundary().size(); ++k)
    if (const int tag = mesh.boundary()[k].tag;
        tag >= 0 && std::ranges::find(names, mesh.boundary_names()[tag]) != names.end())
      numbers.push_back(k);
  return numbers;
}

template class Mesh<2>;
template class Mesh<3>;
template std::vector<std::size_t> facets_named(const Mesh<2>&, std::span<const std::string>);
template std::vector<std::size_t> facets_named(const Mesh<3>&, std::span<const std::string>);

}  // namespace tribound::mesh
