#pragma once

/// @file rigid_part.h
/// A part of the boundary that moves as a rigid body, under a force and a moment.

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::problem
{

/// The components of t, then of w, in 2D and in 3D.
template <int dim>
inline constexpr std::array<std::string_view, dim*(dim + 1) / 2> motion_names{};
template <>
inline constexpr std::array<std::string_view, 3> motion_names<2>{"x", "y", "rz"};
template <>
inline constexpr std::array<std::string_view, 6> motion_names<3>{"x", "y", "z", "rx", "ry", "rz"};

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

  [[nodiscard]] Point<dim> total_force() const { return values<dim>(force); }
  [[nodiscard]] Point<n_rotations> total_moment() const { return values<n_rotations>(moment); }
  [[nodiscard]] bool fixes_any() const { return std::ranges::any_of(fixed, std::identity()); }

 private:
  template <int n>
  [[nodiscard]] Point<n> values(const std::array<Field, n>& fields) const
  {
    Point<n> result;
    for (int i = 0; i < n; ++i) result[i] = fields[i](point);
    return result;
  }
};

}  // namespace tribound::problem
