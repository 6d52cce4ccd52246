#pragma once

/// @file surface.h
/// Surfaces by formulas: rigid obstacles, and the true shape of a body whose boundary is meshed by straight
/// facets. The gaps and directions of contact that follow from them are formulas as well, so that the
/// certificate encloses them like any other datum.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/problem/problem.h"

namespace tribound::problem
{

/// A surface by formulas of x, y, z.
struct Surface
{
  std::string distance{};             ///< phi, signed
  std::vector<std::string> normal{};  ///< grad phi, a unit vector
  std::vector<std::string>
      closest{};  ///< the nearest point of the surface; empty: there is no formula for it
};

/// On which side of a round surface phi > 0.
enum class Positive
{
  outside,
  inside
};

/// The line (2D) or plane through `point`; phi > 0 on the side into which `normal` points, of any length but
/// 0.
[[nodiscard]] Surface plane(std::span<const double> point, std::span<const double> normal);

/// The circle (2D) or sphere.
[[nodiscard]] Surface sphere(std::span<const double> centre, double radius, Positive side);

/// The cylinder around the line through `centre` along `axis`, of any length but 0.
[[nodiscard]] Surface cylinder(std::span<const double> centre, std::span<const double> axis, double radius,
                               Positive side);

/// The zeros of `formula`, of `dim` coordinates: phi = formula / |grad formula|, which is the distance to
/// first order, and the exact one where |grad formula| = 1. Throws as Formula does.
[[nodiscard]] Surface implicit(const std::string& formula, int dim, const Where& where);

/// The surface moved by `by`.
[[nodiscard]] Surface moved(const Surface& surface, std::span<const double> by, const Where& where);

/// The surfaces that contact is made from; `where` stands for them in messages.
struct ContactGeometry
{
  std::optional<Surface> obstacle{};  ///< phi > 0 where the body is
  std::optional<Surface> shape{};     ///< the true surface of the body, with `closest`; phi > 0 outside of it
  Where where{};
};

/// g(x) = phi(X), X the point of the shape that is nearest to x, or x itself. Needs an obstacle.
[[nodiscard]] Field gap_of(const ContactGeometry& geometry);

/// N(x) = -grad phi(X): towards the obstacle. Needs an obstacle.
[[nodiscard]] NormalField direction_of_obstacle(const ContactGeometry& geometry);

/// N(x) = grad phi of the shape: its outward normal. Needs a shape.
[[nodiscard]] NormalField direction_of_shape(const ContactGeometry& geometry);

/// The vector with the given formulas as components, divided by its length.
[[nodiscard]] NormalField direction_along(std::span<const std::string> components, const Where& where);

}  // namespace tribound::problem
