#include "tribound/mesh/gmsh_elements.h"

#include <fmt/format.h>

#include "tribound/mesh/gmsh_library.h"

namespace tribound::mesh
{

int mesh_dimension(const Where& where)
{
  for (const int dim : {3, 2})
    if (!gmsh::element_types(dim).empty()) return dim;
  throw InputError(
      where, "the mesh has neither triangles nor tetrahedra",
      "mesh the surface (gmsh -2) or the volume (gmsh -3), and put it into a physical group if any "
      "groups exist: Gmsh saves only what is in a group");
}

namespace
{

[[noreturn]] void reject_element_type(const Where& where, int type)
{
  const auto [name, order] = gmsh::element_properties(type);
  if (order != 1)
    throw InputError(where, fmt::format("the mesh has elements of order {} ({})", order, name),
                     "the geometry is straight-sided whatever the degree of the case; mesh with -order 1 "
                     "(Mesh.ElementOrder=1)");
  throw InputError(where, fmt::format("the mesh has elements that are not simplices ({})", name),
                   "only triangles and tetrahedra; mesh with Mesh.RecombineAll=0 and without Recombine or "
                   "Layers{...} with Recombine");
}

}  // namespace

// Gmsh tells the type of the first element of an entity for all of that shape, and reading nodes by type
// overruns its arrays where a second-order element comes later: look at each element first.
void check_element_types(const Where& where, int mesh_dim)
{
  for (const int dim : {mesh_dim, mesh_dim - 1})
  {
    for (const int type : gmsh::element_types(dim))
      if (type != simplex_type[dim]) reject_element_type(where, type);
    for (const std::size_t element : gmsh::elements(simplex_type[dim]))
      if (const int type = gmsh::element_type(element); type != simplex_type[dim])
        reject_element_type(where, type);
  }
}

}  // namespace tribound::mesh
