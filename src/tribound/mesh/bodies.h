#pragma once

/// @file bodies.h
/// The bodies of a mesh: its parts that are connected through facets.

#include <vector>

#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

struct Bodies
{
  std::vector<int> of_cell;  ///< per cell, ghosts included
  int n = 0;
};

/// Bodies are numbered by their first cells, the same on all ranks, which call it together. For cells that
/// are picked out: the numbers of the mesh they come from.
template <int dim>
[[nodiscard]] Bodies number_bodies(const Mesh<dim>& mesh);

}  // namespace tribound::mesh
