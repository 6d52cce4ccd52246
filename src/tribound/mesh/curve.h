#pragma once

/// @file curve.h
/// Curves through all places of a cube, as keys that sort points along them.

#include <cstdint>
#include <span>

#include "tribound/base/types.h"

namespace tribound::mesh
{

/// A cube, or square, around points.
template <int dim>
struct Cube
{
  Point<dim> lower = Point<dim>::Zero();
  double size = 1;
};
template <int dim>
[[nodiscard]] Cube<dim> cube_around(std::span<const Point<dim>> points);

/// Position of a point along Hilbert's curve, on a grid of 2^31 (2D) or 2^21 (3D) steps along each axis
/// [Skilling04]. Points with close keys are close in space.
template <int dim>
[[nodiscard]] std::uint64_t hilbert_key(const Cube<dim>& cube, const Point<dim>& x);

/// The same along Morton's curve, which is cheaper and jumps.
template <int dim>
[[nodiscard]] std::uint64_t morton_key(const Cube<dim>& cube, const Point<dim>& x);

}  // namespace tribound::mesh
