#pragma once

/// @file cut_facets.h
/// Cells cut in fans, in 2D, so that boundary facets end at given points.

#include <span>
#include <vector>

#include "tribound/mesh/bisect.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Where a boundary facet of a cell is to be cut.
struct FacetCuts
{
  Index cell;
  int local;               ///< of the facet
  std::vector<double> at;  ///< ascending in (0, 1), from the first vertex of facet_vertices() to the second
};

/// The mesh with new vertices at the cuts, and the cells there cut from them to the opposite vertex; all
/// other cells stay as they are. A cell may have cuts on several facets. Regions, tags and names are
/// inherited; bisection starts anew with the longest edges of the pieces. Throws InputError where the result
/// is no mesh.
[[nodiscard]] Bisected<2> cut_facets(const Mesh<2>& mesh, std::span<const FacetCuts> cuts);

/// The same for own cells of a rank; `cuts` are of own cells. Throws InputError, on all ranks, where cells
/// outgrow CellName::max_depth.
[[nodiscard]] BisectedPart<2> cut_facets_part(const Mesh<2>& mesh, std::span<const FacetCuts> cuts);

}  // namespace tribound::mesh
