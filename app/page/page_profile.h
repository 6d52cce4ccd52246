#pragma once

/// @file page_profile.h
/// The contact boundary in 2D as curves over its length, for the report page.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::app
{

/// The state along the contact boundary number `tag`; entry i of every column belongs to point i. The points
/// are evenly spaced on each segment, ends included, in the order of contact_chains(). Where two segments
/// join, the point appears twice, since tractions may be discontinuous.
struct ContactProfile
{
  int tag = 0;
  std::vector<double> arc;           ///< length along the boundary
  std::vector<double> points;        ///< x, y of each point, undeformed
  std::vector<double> displacement;  ///< its components
  std::vector<double> normal;        ///< components of n
  std::vector<double> pressure;
  std::vector<double> friction;  ///< T.t, t = n turned by +90 degrees
  std::vector<double> limit;     ///< bound of |T.t|
  std::vector<double> gap;
  std::vector<double> slip;     ///< u.t
  std::vector<Index> status;    ///< ContactStatus
  std::vector<double> damage;   ///< D and the opening delta^n at the end of the step; empty
  std::vector<double> opening;  ///< without a bond
  std::vector<double> water;    ///< p_w; empty without water
  std::vector<Index> bodies;    ///< body of each point
  /// Between bodies: Pi(x), its displacement and its body.
  std::vector<double> opposite;
  std::vector<double> opposite_displacement;
  std::vector<Index> opposite_bodies;
};

/// The profile of every boundary with contact, of about `n_points` points each, at least p + 1 per segment.
[[nodiscard]] std::vector<ContactProfile> contact_profiles(const contact::NitscheForm<2>& form,
                                                           std::span<const double> u,
                                                           std::size_t n_points = 2000);

}  // namespace tribound::app
