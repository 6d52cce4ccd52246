#include "tribound/mesh/gmsh_elements.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <string>
#include <vector>

namespace tribound::mesh
{

int mesh_dimension(const Where& where)
{
  for (const int dim : {3, 2})
  {
    std::vector<int> types;
    gmsh::model::mesh::getElementTypes(types, dim);
    if (!types.empty()) return dim;
  }
  throw InputError(
      where, "the mesh has neither triangles nor tetrahedra",
      "mesh the surface (gmsh -2) or the volume (gmsh -3), and put it into a physical group if any "
      "groups exist: Gmsh saves only what is in a group");
}

namespace
{

[[noreturn]] void reject_element_type(const Where& where, int type)
{
  std::string name;
  int dim = 0;
  int order = 0;
  int n_nodes = 0;
  int n_primary = 0;
  std::vector<double> nodes;
  gmsh::model::mesh::getElementProperties(type, name, dim, order, n_nodes, nodes, n_primary);
  if (order != 1)
    throw InputError(where, fmt::format("the mesh has elements of order {} ({})", order, name),
                     "the geometry is straight-sided whatever the degree of the case; mesh with -order 1 "
                     "(Mesh.ElementOrder=1)");
  throw InputError(where, fmt::format("the mesh has elements that are not simplices ({})", name),
                   "only triangles and tetrahedra; mesh with Mesh.RecombineAll=0 and without Recombine or "
                   "Layers{...} with Recombine");
}

/// Gmsh's number of the type of an element; later versions than 4.8 also return where it is.
template <class Tag>
int element_type(Tag element)
{
  int type = 0;
  std::vector<std::size_t> nodes;
  if constexpr (requires { gmsh::model::mesh::getElement(element, type, nodes); })
    gmsh::model::mesh::getElement(element, type, nodes);
  else
  {
    int dim = 0;
    int entity = 0;
    gmsh::model::mesh::getElement(element, type, nodes, dim, entity);
  }
  return type;
}

}  // namespace

// Gmsh tells the type of the first element of an entity for all of that shape, and reading nodes by type
// overruns its arrays where a second-order element comes later: look at each element first.
void check_element_types(const Where& where, int mesh_dim)
{
  for (const int dim : {mesh_dim, mesh_dim - 1})
  {
    std::vector<int> types;
    gmsh::model::mesh::getElementTypes(types, dim);
    for (const int type : types)
      if (type != simplex_type[dim]) reject_element_type(where, type);

    std::vector<std::size_t> elements;
    std::vector<std::size_t> no_nodes;
    gmsh::model::mesh::preallocateElementsByType(simplex_type[dim], true, false, elements, no_nodes);
    if (elements.empty()) continue;
    gmsh::model::mesh::getElementsByType(simplex_type[dim], elements, no_nodes);
    for (const std::size_t element : elements)
      if (const int type = element_type(element); type != simplex_type[dim]) reject_element_type(where, type);
  }
}

}  // namespace tribound::mesh
