#pragma once

/// @file surface_points.h
/// Gaps and directions from surfaces of which only points are known: at least one is made of triangles.

#include <functional>
#include <memory>
#include <optional>

#include "tribound/mesh/quadratic_surface.h"
#include "tribound/mesh/triangulated_surface.h"
#include "tribound/problem/surface.h"

namespace tribound::case_file
{

/// A surface in space: phi, grad phi, of triangles the smoothed normal with the sign of phi, and the nearest
/// point.
struct SurfacePoints
{
  std::function<double(const Point<3>&)> distance;
  std::function<Point<3>(const Point<3>&)> normal;
  std::function<Point<3>(const Point<3>&)> closest;
};

[[nodiscard]] SurfacePoints points_of(const problem::Surface& surface, const Where& where);
/// Moved by `shift`; phi is `sign` times the distance.
[[nodiscard]] SurfacePoints points_of(std::shared_ptr<const mesh::TriangulatedSurface> triangles, double sign,
                                      const Point<3>& shift);
/// As a shape: X in the place of the nearest point.
[[nodiscard]] SurfacePoints points_of(const std::shared_ptr<const mesh::QuadraticSurface<3>>& shape);

/// What problem::ContactGeometry is for formulas. Functions without enclosures: the certificate says so.
struct PointGeometry
{
  std::optional<SurfacePoints> obstacle{};
  std::optional<SurfacePoints> shape{};
  Where where{};
};

[[nodiscard]] problem::Field gap_of(const PointGeometry& geometry);
[[nodiscard]] problem::NormalField direction_of_obstacle(const PointGeometry& geometry);
[[nodiscard]] problem::NormalField direction_of_shape(const PointGeometry& geometry);
/// The signed distance from the shape.
[[nodiscard]] problem::Field distance_of_shape(const PointGeometry& geometry);

}  // namespace tribound::case_file
