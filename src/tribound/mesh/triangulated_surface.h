#pragma once

/// @file triangulated_surface.h
/// Surfaces made of triangles, from STL files: nearest points, signed distances, smoothed normals.

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/mesh/box_tree.h"

namespace tribound::mesh
{

/// Triangles in space. Copies are expensive; several threads may use one object at once.
class TriangulatedSurface
{
 public:
  using Triangle = std::array<Index, 3>;

  /// Vertices in one place, to the last bit, are merged, and triangles without area are left out. A closed
  /// surface is turned so that the normals point out of what it encloses. Throws InputError: no triangle, an
  /// edge in more than two triangles, neighbours whose normals point to different sides.
  TriangulatedSurface(std::span<const Point<3>> vertices, std::span<const Triangle> triangles,
                      const Where& where);

  [[nodiscard]] std::size_t n_triangles() const { return triangles_.size(); }
  /// Whether every edge belongs to two triangles.
  [[nodiscard]] bool is_closed() const { return is_closed_; }
  /// The largest of the shells of a closed surface, and those outside of it. The others are its cavities,
  /// whichever way their normals point.
  [[nodiscard]] std::size_t n_bodies() const;

  struct Nearest
  {
    Point<3> point;   ///< of the surface
    double distance;  ///< positive on the side into which the normals point
    Point<3> normal;  ///< a unit vector: normals of the vertices interpolated on the triangle
  };
  /// The nearest point of the surface. Its side follows from the pseudonormal of the triangle, edge or vertex
  /// it is on: the normals around it weighted by angles (Baerentzen and Aanaes 2005).
  [[nodiscard]] Nearest nearest(const Point<3>& x) const;

 private:
  void join(std::span<const Point<3>> vertices, std::span<const Triangle> triangles);
  void find_neighbours(const Where& where);
  void find_normals();
  void turn_outward();
  /// Triangles connected by edges.
  [[nodiscard]] std::vector<std::vector<Triangle>> shells() const;
  /// Six times what they enclose; negative if their normals point into it.
  [[nodiscard]] double six_volumes(std::span<const Triangle> shell) const;

  std::vector<Point<3>> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Point<3>> normals_;  ///< of the triangles
  std::vector<std::array<Point<3>, 3>>
      edge_normals_;                              ///< sums over the triangles of edge i, opposite vertex i
  std::vector<Point<3>> vertex_normals_;          ///< unit vectors
  std::vector<std::array<Index, 3>> neighbours_;  ///< across edge i; -1: none
  bool is_closed_ = false;
  BoxTree<3> tree_{{}};
};

/// Reads an STL file, ASCII or binary. Throws InputError naming `where` if it is not one.
[[nodiscard]] TriangulatedSurface read_stl(const std::filesystem::path& file, const Where& where);

}  // namespace tribound::mesh
