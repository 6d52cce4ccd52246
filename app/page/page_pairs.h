#pragma once

/// @file page_pairs.h
/// What bodies touch each other with, for the report page: in 3D segments on the faces of both sides; and
/// which way bodies move apart.

#include <array>
#include <span>
#include <vector>

#include "app/page/page_surface.h"

namespace tribound::app
{

/// Triangles on faces of a Surface.
struct FaceParts
{
  std::vector<Index> faces;
  /// Three corners each: their coordinates (i, j) / k on the face; empty: the whole faces.
  std::vector<double> corners;
};

/// Contact with other bodies on one boundary: triangles with values at the points of their lattices.
struct PairSurface
{
  int tag = 0;  ///< of the slave
  int subdivision = 1;
  FaceParts slave{};
  FaceParts master{};  ///< triangle i lies opposite triangle i of the slave; one of the sides may be absent
  SurfaceContact values{};
};

/// The segments between bodies, a PairSurface for each slave. Beyond limits.segments two: one with means over
/// the slave's facets, one with means over the master's. Faces that `surface` does not have are left out.
[[nodiscard]] std::vector<PairSurface> sample_pairs(const contact::NitscheForm<3>& form,
                                                    std::span<const double> u, const Surface& surface,
                                                    const PageLimits& limits = {});

/// Where two bodies touch.
template <int dim>
struct BodyInterface
{
  std::array<Index, 2> bodies;  ///< slave, master
  double measure = 0;
  Point<dim> normal = Point<dim>::Zero();  ///< mean of the slave's normals: shorter than 1 where they turn
  Point<dim> axis = Point<dim>::Zero();  ///< unit vector to which they are orthogonal, as far as there is one
};

/// Of every pair of different bodies.
template <int dim>
[[nodiscard]] std::vector<BodyInterface<dim>> body_interfaces(const contact::NitscheForm<dim>& form);

}  // namespace tribound::app
