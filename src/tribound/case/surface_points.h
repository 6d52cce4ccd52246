#pragma once

/// @file surface_points.h
/// Gaps and directions from surfaces of which only points are known: at least one is made of triangles.

#include <memory>
#include <optional>

#include "tribound/mesh/triangulated_surface.h"
#include "tribound/problem/surface.h"

namespace tribound::case_file
{

/// A surface in space, by formulas or by triangles.
class SurfacePoints
{
 public:
  SurfacePoints(const problem::Surface& surface, const Where& where);
  /// Moved by `shift`; phi is `sign` times the distance.
  SurfacePoints(std::shared_ptr<const mesh::TriangulatedSurface> triangles, double sign, Point<3> shift);

  [[nodiscard]] double distance(const Point<3>& x) const;
  /// grad phi; of triangles the smoothed normal with the sign of phi.
  [[nodiscard]] Point<3> normal(const Point<3>& x) const;
  [[nodiscard]] Point<3> closest(const Point<3>& x) const;

 private:
  struct Formulas
  {
    problem::Field distance;
    std::vector<problem::Field> normal;
    std::vector<problem::Field> closest;
  };
  std::optional<Formulas> formulas_;
  std::shared_ptr<const mesh::TriangulatedSurface> triangles_;
  double sign_ = 1;
  Point<3> shift_ = Point<3>::Zero();
};

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
