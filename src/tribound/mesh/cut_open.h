#pragma once

/// @file cut_open.h
/// Joints: facets inside a mesh along which it is cut open.

#include <span>
#include <string>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Cuts the mesh open along the facets of the named groups, which lie inside. A vertex gets a copy for each
/// part into which the cuts divide the cells around it: the rim of a joint that ends inside the body keeps
/// one, where two joints cross there are four. Then the group NAME is the side of the cell with the smaller
/// number at its first facet and what continues it. The other side is a new group NAME.other, and both are an
/// interface. Groups that are no boundaries of the mesh are left to the problem to report.
///
/// Throws InputError for a facet of a joint that is on the boundary or in two groups, for a joint without two
/// sides, for a group NAME.other that exists, and as check_arrays() and check_facets().
template <int dim>
void cut_open(MeshData<dim>& data, std::span<const std::string> joints);

}  // namespace tribound::mesh
