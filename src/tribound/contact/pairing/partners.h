#pragma once

/// @file partners.h
/// Pairs on several ranks: brings the cells opposite those of a rank to it.

#include <span>

#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// The mesh with the cells that overlay() needs as ghosts. Consider a facet of a cell with a vertex whose
/// patch is on this rank. Rows of the matrix, patches and moments on it are sums over all its segments. For a
/// slave facet the cells below it are added; for a master facet the slaves above it and all that lies below
/// those, since the nearest counts. All ranks call it together. The data exchanged have the size of the
/// contact boundary of each rank and of what lies opposite: a facet with many small ones below it brings them
/// all. An undistributed mesh is returned unchanged. Throws InputError as overlay() does for a direction.
template <int dim>
[[nodiscard]] mesh::Mesh<dim> with_partners(mesh::Mesh<dim> mesh,
                                            std::span<const problem::ContactPair<dim>> pairs);

}  // namespace tribound::contact
