#include "tribound/mesh/gmsh_elements.h"

#include <fmt/format.h>

#include <cstddef>

#include "tribound/mesh/gmsh_library.h"

namespace tribound::mesh
{

int mesh_dimension(const Where& where)
{
  for (const int dim : {3, 2})
    if (!gmsh::element_types(dim).empty()) return dim;
  throw InputError(where, "the mesh has neither triangles nor tetrahedra",
                   "a 2D problem needs a meshed surface, a 3D problem a meshed volume; put it into a "
                   "physical group if any "
                   "groups exist: Gmsh saves only what is in a group");
}

namespace
{

/// Throws unless it is the type of a simplex of order 1 or 2.
int order_of_simplex(const Where& where, int dim, int type)
{
  for (std::size_t k = 0; k < simplex_type.size(); ++k)
    if (type == simplex_type[k][dim]) return static_cast<int>(k) + 1;
  const auto [name, order] = gmsh::element_properties(type);
  if (order > static_cast<int>(simplex_type.size()))
    throw InputError(where, fmt::format("the mesh has elements of order {} ({})", order, name),
                     "the geometry is straight-sided whatever the degree of the case, and a shape needs no "
                     "more than order 2; mesh with Mesh.ElementOrder = 1 or 2");
  throw InputError(where, fmt::format("the mesh has elements that are not simplices ({})", name),
                   "only triangles and tetrahedra; mesh with Mesh.RecombineAll=0 and without Recombine or "
                   "Layers{...} with Recombine");
}

}  // namespace

// Gmsh reports the type of the first element of an entity for all elements of that shape. Reading nodes by
// type then overruns its arrays if a second-order element comes later, so each element is looked at first.
int mesh_order(const Where& where, int mesh_dim)
{
  int order = 0;
  const auto look = [&](int dim, int type)
  {
    const int found = order_of_simplex(where, dim, type);
    if (order == 0) order = found;
    if (found != order)
      throw InputError(where, fmt::format("the mesh has elements of order {} and of order {}", order, found),
                       "all cells and facets of one order: mesh again, with Mesh.ElementOrder = 1 or 2");
  };
  for (const int dim : {mesh_dim, mesh_dim - 1})
    for (const int type : gmsh::element_types(dim)) look(dim, type);
  for (const int dim : {mesh_dim, mesh_dim - 1})
    for (const std::size_t element : gmsh::elements(simplex_type[order - 1][dim]))
      look(dim, gmsh::element_type(element));
  return order;
}

}  // namespace tribound::mesh
