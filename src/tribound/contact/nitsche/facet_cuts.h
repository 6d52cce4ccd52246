#pragma once

/// @file facet_cuts.h
/// What it takes for the facets of bodies in contact to match.

#include <span>
#include <vector>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/cut_facets.h"

namespace tribound::contact
{

/// Whether every segment is a facet against an obstacle or all of two facets. The same on all ranks, which
/// call it together.
template <int dim>
[[nodiscard]] bool facets_match(const mesh::Mesh<dim>& mesh, std::span<const ContactSegment<dim>> segments);

/// Where facets of own cells are to be cut for them to match: at the ends of segments inside them.
[[nodiscard]] std::vector<mesh::FacetCuts> facet_cuts(const mesh::Mesh<2>& mesh,
                                                      std::span<const ContactSegment<2>> segments);

/// Removes segments that are nothing but the rounding of these cuts.
template <int dim>
void erase_slivers(const mesh::Mesh<dim>& mesh, std::vector<ContactSegment<dim>>& segments);

}  // namespace tribound::contact
