#pragma once

/// @file partners.h
/// Pairs on several ranks: what lies opposite the cells of a rank comes to it.

#include <span>

#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// The mesh with the cells that overlay() needs as ghosts. Rows of the matrix, patches and moments on a facet
/// of a cell with a vertex whose patch is here are sums over all segments of the facet: of a slave the cells
/// below it come, of a master the slaves above it and all that lies below those, since the nearest counts.
/// All ranks call it together; what is exchanged is of the size of the contact boundary of each, and of what
/// lies opposite to it: a facet with many small ones below it brings them all. A mesh that is whole stays as
/// it is. Throws InputError as overlay() does for a direction.
template <int dim>
[[nodiscard]] mesh::Mesh<dim> with_partners(mesh::Mesh<dim> mesh,
                                            std::span<const problem::ContactPair<dim>> pairs);

}  // namespace tribound::contact
