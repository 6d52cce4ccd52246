#include "tribound/mesh/mesh.h"

#include <utility>

#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

template <int dim>
Mesh<dim>::Mesh(MeshData<dim> data)
{
  check_arrays(data);
  check_shapes(data);
  Topology<dim> topology = build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  check_facets(data, topology);
  check_conformity(data, topology);
  if (data.bisection_types.empty()) check_overlap(data, topology);  // bisection keeps the domain
  boundary_ = find_boundary(data, topology);
  check_vertices(data, topology);

  vertices_ = std::move(data.vertices);
  cells_ = std::move(data.cells);
  regions_ = std::move(data.regions);
  region_names_ = std::move(data.region_names);
  boundary_names_ = std::move(data.boundary_names);
  source_ = std::move(data.source);
  bisection_types_ = std::move(data.bisection_types);
  ancestry_ = std::move(data.ancestry);
  topology_ = std::make_unique<const Topology<dim>>(std::move(topology));
}

template class Mesh<2>;
template class Mesh<3>;

}  // namespace tribound::mesh
