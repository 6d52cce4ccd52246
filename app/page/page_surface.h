#pragma once

/// @file page_surface.h
/// The body as triangles for the report page: the cells in 2D, the boundary facets in 3D.

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/io/fields/tensor_field.h"

namespace tribound::app
{

/// Sizes up to which the page shows a mesh unchanged.
struct PageLimits
{
  int degree = 0;                   ///< that is shown at least, even where that of the displacement is lower
  std::size_t subdivided = 24'000;  ///< triangles up to which faces are subdivided, to show the degree
  std::size_t triangles = 240'000;  ///< triangles of a level; beyond, cells are merged
  std::size_t stresses = 24'000;    ///< triangles up to which stresses are given at points, not per face
  std::size_t earlier = 40'000;     ///< triangles of all levels before the last; beyond, they are omitted
  std::size_t segments = 40'000;    ///< between bodies; beyond, contact values are means over facets
  std::size_t volume = 40'000;      ///< cells in 3D; beyond, the interior is omitted
};

/// Values at the lattice points of faces, see Surface.
struct SurfaceContact
{
  void resize(std::size_t n_points, std::size_t n_triangles);
  void set_point(std::size_t i, const contact::ContactState<3>& state);

  std::vector<double> pressure;
  std::vector<double> friction;  ///< |T^t|
  std::vector<double> limit;     ///< its bound
  std::vector<double> gap;
  std::vector<double> slip;         ///< |u^t|
  std::vector<Index> point_status;  ///< ContactStatus
  std::vector<Index> status;        ///< the same at the middle of each triangle
};

/// The columns that are numbers.
inline constexpr std::array value_columns = {&SurfaceContact::pressure, &SurfaceContact::friction,
                                             &SurfaceContact::limit, &SurfaceContact::gap,
                                             &SurfaceContact::slip};

/// Faces with a lattice of (k + 1)(k + 2) / 2 vertices each, which cuts them into k^2 triangles. Point i of
/// row j has barycentric coordinates (k - i - j, i, j) / k with respect to the corners; rows j = 0 ... k
/// follow one another. Corners are anticlockwise as seen from outside, in 2D from above. Neighbours share
/// vertices.
struct Surface
{
  int subdivision = 1;               ///< k
  std::vector<double> points;        ///< dim coordinates per vertex
  std::vector<double> displacement;  ///< dim components per vertex
  std::vector<Index> faces;          ///< vertices of the lattice, face by face
  std::vector<Index> cells;          ///< per face: its cell
  std::vector<Index> bodies;         ///< per face: its body, numbered as in the certificate
  std::vector<Index> facets;         ///< 3D, per face: its number in Mesh::boundary()
  /// sigma_h by component (xx, yy, xy, with initial stress what it adds to zz; in 3D xx, yy, zz, xy, yz, xz):
  /// at every lattice point of every face, where it may be discontinuous, or one value per face.
  std::vector<std::vector<double>> stress;
  double merged_below = 0.0;  ///< length below which details are merged; 0: none are
  SurfaceContact contact;     ///< 3D: on the first faces, which are those of Gamma_C

  [[nodiscard]] std::size_t n_face_points() const { return (subdivision + 1) * (subdivision + 2) / 2; }
  [[nodiscard]] std::size_t n_faces() const { return cells.size(); }
  [[nodiscard]] std::size_t n_triangles() const { return n_faces() * subdivision * subdivision; }
};

/// Entries of symmetric_part() that a page contains.
template <int dim>
inline constexpr std::array<int, 6> stress_entries = {0, 1, 2, 3, 4, 5};
template <>
inline constexpr std::array<int, 3> stress_entries<2> = {0, 1, 3};

/// k: the degree of the fields shown, or less if that would give more than `max_triangles`.
[[nodiscard]] int subdivision(std::size_t n_faces, int degree, std::size_t max_triangles);

/// The lattice points of a face in the order of Surface, and the middles of its triangles: row by row, in
/// each row alternately those that point up and down. Coordinates (i, j) / k, exchanged if `swapped`.
[[nodiscard]] std::vector<Point<2>> lattice_points(int k, bool swapped);
[[nodiscard]] std::vector<Point<2>> triangle_middles(int k, bool swapped);

/// Whether the coordinates of facet `local` of a tetrahedron must be exchanged for those of its face.
[[nodiscard]] inline bool turns_the_other_way(int local)
{
  return local % 2 == 1;  // see facet_geometry()
}

/// An upper bound of the number of triangles on the surface of the body on a level.
template <int dim>
[[nodiscard]] std::size_t n_triangles(const contact::NitscheForm<dim>& form, const PageLimits& limits);

/// A stress as a field at the nodes of a space, which outlives the field.
template <int dim>
using StressAt = std::function<io::TensorField<dim>(const fem::LagrangeSpace<dim>& space)>;

/// The surface of the body with a displacement and a stress.
template <int dim>
[[nodiscard]] Surface sample_surface(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                     const StressAt<dim>& stress, const PageLimits& limits = {});
/// The same on one level.
template <int dim>
[[nodiscard]] Surface sample_surface(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                     const certify::Stress<dim>& stress, const PageLimits& limits = {});

/// Merges the vertices in the same square or cube of a grid and drops the faces that degenerate. The grid
/// width is the smallest for which at most `max_triangles` remain (to within 20 %). Faces keep their values.
/// For k = 1 only.
void merge_details(Surface& surface, int dim, std::size_t max_triangles);

}  // namespace tribound::app
