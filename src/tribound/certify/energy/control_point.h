#pragma once

/// @file control_point.h
/// A coefficient of a displacement in Bernstein's basis, moved to satisfy the contact conditions.

#include <array>
#include <span>

#include "tribound/base/types.h"

namespace tribound::certify
{

/// The conditions of facets with one normal on a control point c that lies on them.
template <int dim>
struct ControlCondition
{
  Point<dim> normal;
  double gap = 0;       ///< n.c <= gap
  bool closed = false;  ///< n.c = gap is wanted
  bool sticks = false;  ///< c - n.c n = 0 is wanted
  double pressure = 0;  ///< stress: the weight of the conditions of closed facets
  double friction = 0;  ///< stress: the weight of the conditions of sticking facets
};

/// The control point nearest to c that meets the conditions of all facets; c does not move along fixed axes.
/// If facets with different normals have incompatible conditions, n.c <= gap holds for all and
///     sum of pressure (n.c - gap)^2 + friction |c - n.c n|^2 + eps |c' - c|^2
/// is minimal, with small eps. If even that is impossible, c.
template <int dim>
[[nodiscard]] Point<dim> moved(const Point<dim>& c, const std::array<bool, dim>& fixed,
                               std::span<const ControlCondition<dim>> conditions);

}  // namespace tribound::certify
