#pragma once

/// @file page_pairs.h
/// Contact between bodies for the report page: in 3D, segments on the faces of both sides; also the
/// directions in which bodies move apart.

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
  /// Three corners each, by coordinates (i, j) / k on the face; empty: the whole faces.
  std::vector<double> corners;
};

/// Contact with other bodies on one boundary: triangles with values at the points of their lattices.
struct PairSurface
{
  int tag = 0;  ///< of the slave
  int subdivision = 1;
  FaceParts slave{};
  FaceParts master{};  ///< triangle i is opposite triangle i of the slave; one of the sides may be absent
  SurfaceContact values{};
};

/// The segments between bodies, one PairSurface for each slave. Beyond limits.segments there are two: one
/// with means over the slave's facets, one with means over the master's. Faces missing in `surface` are
/// omitted.
[[nodiscard]] std::vector<PairSurface> sample_pairs(const contact::NitscheForm<3>& form,
                                                    std::span<const double> u, const Surface& surface,
                                                    const PageLimits& limits = {});

/// The interface between two bodies.
template <int dim>
struct BodyInterface
{
  std::array<Index, 2> bodies;  ///< slave, master
  double measure = 0;
  Point<dim> normal = Point<dim>::Zero();  ///< mean of the slave's normals: shorter than 1 where they vary
  Point<dim> axis = Point<dim>::Zero();    ///< unit vector orthogonal to them, as far as there is one
};

/// For every pair of different bodies.
template <int dim>
[[nodiscard]] std::vector<BodyInterface<dim>> body_interfaces(const contact::NitscheForm<dim>& form);

}  // namespace tribound::app
