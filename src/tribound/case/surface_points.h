#pragma once

/// @file surface_points.h
/// Gaps and directions from surfaces known only by points: at least one consists of triangles, or of
/// second-order facets whose nearest points are searched for.

#include <functional>
#include <memory>
#include <optional>

#include "tribound/mesh/quadratic_surface.h"
#include "tribound/mesh/triangulated_surface.h"
#include "tribound/problem/surface.h"

namespace tribound::case_file
{

/// A surface: phi, grad phi and the nearest point. For triangles and facets, the smoothed normal with the
/// sign of phi replaces grad phi.
template <int dim>
struct SurfacePoints
{
  std::function<double(const Point<dim>&)> distance;
  std::function<Point<dim>(const Point<dim>&)> normal;
  std::function<Point<dim>(const Point<dim>&)> closest;
};

template <int dim>
[[nodiscard]] SurfacePoints<dim> points_of(const problem::Surface& surface, const Where& where);
/// Translated by `shift`; phi is `sign` times the distance.
[[nodiscard]] SurfacePoints<3> points_of(std::shared_ptr<const mesh::TriangulatedSurface> triangles,
                                         double sign, const Point<3>& shift);
/// As the shape of the body with these facets: X replaces the nearest point.
template <int dim>
[[nodiscard]] SurfacePoints<dim> points_on(const std::shared_ptr<const mesh::QuadraticSurface<dim>>& shape);
/// For points of other bodies: by mesh::QuadraticSurface::foot().
template <int dim>
[[nodiscard]] SurfacePoints<dim> points_around(
    const std::shared_ptr<const mesh::QuadraticSurface<dim>>& shape);

/// The analogue of problem::ContactGeometry, which is for formulas. These functions have no enclosures; the
/// certificate says so.
template <int dim>
struct PointGeometry
{
  std::optional<SurfacePoints<dim>> obstacle{};
  std::optional<SurfacePoints<dim>> shape{};
  Where where{};
};

template <int dim>
[[nodiscard]] problem::Field gap_of(const PointGeometry<dim>& geometry);
template <int dim>
[[nodiscard]] problem::NormalField direction_of_obstacle(const PointGeometry<dim>& geometry);
template <int dim>
[[nodiscard]] problem::NormalField direction_of_shape(const PointGeometry<dim>& geometry);
/// The signed distance from the shape.
template <int dim>
[[nodiscard]] problem::Field distance_of_shape(const PointGeometry<dim>& geometry);

}  // namespace tribound::case_file
