#pragma once

/// @file facet_cover.h
/// A triangulation of a facet that goes with the parts of it below contact segments.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/fem/simplex_parts.h"

namespace tribound::certify
{

/// A conforming triangulation of the reference triangle.
struct FacetCover
{
  struct Triangle
  {
    std::array<int, 3> corners;  ///< anticlockwise
    int part;                    ///< in which it lies, -1 where there is none
  };
  std::vector<Point<2>> vertices;
  std::vector<Triangle> triangles;
};

/// Of parts that do not overlap; they need not conform, nor cover the facet. Corners are one where they are
/// closer than 1e-11. Nothing where parts overlap, or leave gaps too narrow to tell from rounding.
[[nodiscard]] std::optional<FacetCover> conforming_cover(std::span<const fem::Part<2>> parts);

}  // namespace tribound::certify
