#pragma once

/// @file facet_cuts.h
/// Cuts that make the facets of bodies in contact match.

#include <span>
#include <vector>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/cut_facets.h"

namespace tribound::contact
{

/// Whether a segment is a whole facet against an obstacle or the whole of two facets.
template <int dim>
[[nodiscard]] bool is_whole(const mesh::Mesh<dim>& mesh, const ContactSegment<dim>& segment)
{
  return segment.is_obstacle_facet() || matching_facets<dim>(mesh, segment);
}

/// Whether this holds for every segment. The same on all ranks, which call it together.
template <int dim>
[[nodiscard]] bool facets_match(const mesh::Mesh<dim>& mesh, std::span<const ContactSegment<dim>> segments);

/// Where facets of own cells must be cut to match: at the ends of segments inside them.
[[nodiscard]] std::vector<mesh::FacetCuts> facet_cuts(const mesh::Mesh<2>& mesh,
                                                      std::span<const ContactSegment<2>> segments);

/// Removes segments that are only the rounding of these cuts.
template <int dim>
void erase_slivers(const mesh::Mesh<dim>& mesh, std::vector<ContactSegment<dim>>& segments);

}  // namespace tribound::contact
