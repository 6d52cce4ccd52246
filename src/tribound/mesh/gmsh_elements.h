#pragma once

/// @file gmsh_elements.h
/// The elements of the model that Gmsh has loaded.

#include <optional>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/mesh/import/element_type.h"

namespace tribound::mesh
{

/// A type of elements by Gmsh's number.
struct GmshType
{
  int number;
  ElementType type;
  std::vector<int> order;  ///< place in Gmsh's list of nodes of each node of ElementType
};

/// The type with this number of Gmsh's; nothing if it is not read.
[[nodiscard]] std::optional<ElementType> gmsh_type(int number);

/// Gmsh's number of a known type, and the order of its nodes.
[[nodiscard]] GmshType to_gmsh(const ElementType& type);

/// 3 if there are solids of any shape, else 2. Throws InputError where there are no surfaces either.
[[nodiscard]] int mesh_dimension(const Where& where);

/// Throws InputError where cells and facets are of different orders, or of an order or a shape that is not
/// read.
void check_elements(const Where& where, int mesh_dim);

/// The types of the elements of this dimension, which are checked.
[[nodiscard]] std::vector<GmshType> gmsh_types(const Where& where, int dim);

}  // namespace tribound::mesh
