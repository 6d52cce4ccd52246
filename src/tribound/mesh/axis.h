#pragma once

/// @file axis.h
/// The axis x = 0 of bodies of revolution, whose meridian is a mesh.

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Moves vertices that rounding has put beside the axis onto it: nearer than 1e-10 of the size of the mesh.
/// Throws InputError for a mesh in 3D, and for vertices on the other side.
template <int dim>
void meet_axis(MeshData<dim>& data);

}  // namespace tribound::mesh
