#pragma once

/// @file transfer_terms.h
/// mor of the cells at contact between bodies, method section 5.

#include <map>
#include <span>
#include <vector>

#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/transfer.h"

namespace tribound::certify
{

/// What a contact traction t loses on one boundary facet.
template <int dim>
struct FacetTransfer
{
  mesh::BoundaryFacet facet;
  /// q = Pi_k t, without weight, on the slave, -q |k| / |Pi(k)| on the master, by the parts that the segments
  /// k cover. The parts of a group do not overlap; in 2D there is one group.
  std::vector<std::vector<TractionPiece<dim>>> groups;
};

/// For the own cells with segments of pairs, by cell; t at the contact points of the form.
template <int dim>
[[nodiscard]] std::map<Index, std::vector<FacetTransfer<dim>>> facet_transfers(
    const contact::NitscheForm<dim>& form, const ContactTerms<dim>& terms, std::span<const Point<dim>> t);

}  // namespace tribound::certify
