#pragma once

/// @file control_point.h
/// A coefficient of a displacement in Bernstein's basis, moved to where contact wants it.

#include <array>
#include <span>

#include "tribound/base/types.h"

namespace tribound::certify
{

/// What facets of one normal want of a control point c that lies on them.
template <int dim>
struct ControlCondition
{
  Point<dim> normal;
  double gap = 0;       ///< n.c <= gap
  bool closed = false;  ///< n.c = gap is wanted
  bool sticks = false;  ///< c - n.c n = 0 is wanted
  double pressure = 0;  ///< stress: the weight of what closed facets want
  double friction = 0;  ///< stress: the weight of what sticking facets want
};

/// The control point nearest to c that has what all facets want, c not being moved along fixed axes. Where
/// facets of different normals want what cannot be had together, n.c <= gap holds for all and
///     sum of pressure (n.c - gap)^2 + friction |c - n.c n|^2 + eps |c' - c|^2
/// is least, with small eps; where that cannot be had either, c.
template <int dim>
[[nodiscard]] Point<dim> moved(const Point<dim>& c, const std::array<bool, dim>& fixed,
                               std::span<const ControlCondition<dim>> conditions);

}  // namespace tribound::certify
