#pragma once

/// @file crack_tip.h
/// The extent of the crack in the base of a hydraulic structure (method section 12.6).

#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// Distances from the heel, lengths. The crack is the part with D = 1 and delta^n > 0 that is connected with
/// the heel.
struct CrackTip
{
  /// a. In 2D the midpoint between the last contact point of the crack and the next one; 0 if the first point
  /// does not belong to it, L if all do. In 3D the crack consists of the facets that are open and broken at
  /// all points and are linked by edges to the upstream rim; a = L |crack| / |base|.
  double distance = 0;
  double farthest = 0;  ///< the largest distance of points of the crack; in 2D a
};

/// One for each of form.problem().contacts(), 0 for those without Contact::base; `responses`: by number of
/// the contact points. The upstream rim consists of the edges on the rim of the interface whose normal in the
/// interface makes an angle of less than 60 degrees with toe -> heel. All ranks call it together and get the
/// same numbers.
template <int dim>
[[nodiscard]] std::vector<CrackTip> crack_tips(const NitscheForm<dim>& form,
                                               std::span<const problem::InterfaceResponse<dim>> responses);

}  // namespace tribound::contact
