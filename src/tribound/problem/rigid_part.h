#pragma once

/// @file rigid_part.h
/// A part of the boundary that moves as a rigid body, under a force and a moment.

#include <algorithm>
#include <array>
#include <functional>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::problem
{

/// u = t + w x (x - point) on the boundary, t and w unknown; in 2D w turns in the plane, from x to y.
template <int dim>
struct RigidPart
{
  static constexpr int n_rotations = dim * (dim - 1) / 2;

  std::array<Field, dim> force = {};           ///< in 2D per thickness; formulas of t alone
  std::array<Field, n_rotations> moment = {};  ///< about the point
  Point<dim> point = Point<dim>::Zero();
  /// The components of t, then of w, that are 0.
  std::array<bool, dim + n_rotations> fixed = {};

  [[nodiscard]] bool fixes_any() const { return std::ranges::any_of(fixed, std::identity()); }
};

}  // namespace tribound::problem
