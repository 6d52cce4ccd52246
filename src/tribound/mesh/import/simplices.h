#pragma once

/// @file simplices.h
/// The simplicial mesh of an imported one.

#include <variant>

#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

struct SimplicialMesh
{
  std::variant<MeshData<2>, MeshData<3>> data;
  std::vector<std::string> notes{};  ///< what was left out: "part.msh: ..."
};

/// Cuts all cells into triangles or tetrahedra. Vertices are the corners, in the order of the nodes; nodes
/// that no element uses are left out. Every quadrilateral face is cut through its vertex with the smallest
/// number, and a cell is the cone from its vertex with the smallest number over the faces that do not contain
/// it, so that cells of all types fit together; simplices stay as they are. The cut defines the body where
/// faces are warped. Corners that coincide in an element (a hexahedron as a prism) are allowed.
///
/// Facets of second order leave their nodes as edge_nodes; the middle of the edge that cuts a quadrilateral
/// facet is its centre.
///
/// With `all_middles` the facets of the boundary leave them that are in no set, too: groups by formulas may
/// take these.
///
/// Throws InputError, which names elements and nodes by their numbers in the file: inverted or degenerate
/// cells, cells in no region or in two, a plane mesh that is not in z = 0.
[[nodiscard]] SimplicialMesh make_simplicial(ImportedMesh mesh, bool all_middles = false);

}  // namespace tribound::mesh
