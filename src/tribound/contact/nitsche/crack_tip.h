#pragma once

/// @file crack_tip.h
/// How far the crack in the base of a hydraulic structure has come (method section 12.6).

#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// Distances from the heel, lengths. The crack is where D = 1 and delta^n > 0, as far as it is connected with
/// the heel.
struct CrackTip
{
  /// a. In 2D the middle between its last contact point and the next one; 0 where the first point does not
  /// belong to it, L where all do. In 3D it consists of facets, of which all points are open and broken, and
  /// which edges link to the upstream rim; a = L |crack| / |base|.
  double distance = 0;
  double farthest = 0;  ///< the largest distance of its points; in 2D a
};

/// One for each of form.problem().contacts(), 0 for those without Contact::base; `responses`: by number of
/// the contact points. The upstream rim are edges of the interface at its rim whose normal in it makes an
/// angle of less than 60 degrees with toe -> heel. All ranks call it together, and have the same numbers.
template <int dim>
[[nodiscard]] std::vector<CrackTip> crack_tips(const NitscheForm<dim>& form,
                                               std::span<const problem::InterfaceResponse<dim>> responses);

}  // namespace tribound::contact
