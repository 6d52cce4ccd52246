#pragma once

/// @file meridian_transfer.h
/// mor of axisymmetric problems, where the facets of two bodies do not match (method section 19.6).

#include <map>
#include <span>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// For the own cells with such facets F the sum of C_{T,F} ||q - Pi_F q||_{r,F} over them: q = Pi_k t on the
/// slave, -q |k| / |Pi(k)| on the master, by segments k, and 0 where there is none; t at the contact points
/// of the form. All projections have the weight r.
[[nodiscard]] std::map<Index, double> meridian_transfers(const contact::NitscheForm<2>& form,
                                                         std::span<const Point<2>> t);

}  // namespace tribound::certify
