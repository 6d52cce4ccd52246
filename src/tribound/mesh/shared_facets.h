#pragma once

/// @file shared_facets.h
/// Where the parts of a mesh meet.

#include <vector>

#include "tribound/base/ghost_update.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// The facets between own cells and those of other ranks.
struct SharedFacets
{
  /// A facet of an own cell.
  struct Side
  {
    Index cell;
    int local;
  };

  std::vector<Side> own;
  std::vector<char> is_of_lower;  ///< per facet: whether the cell on the other side belongs to a lower rank
  GhostUpdate update;             ///< of values per facet: from the lower rank to the higher
};

/// For a mesh that is shared out. All ranks call it together.
template <int dim>
[[nodiscard]] SharedFacets shared_facets(const Mesh<dim>& mesh);

}  // namespace tribound::mesh
