#pragma once

/// @file facet_cover.h
/// A triangulation of a facet that conforms to its parts below contact segments.

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
    int part;                    ///< that contains it; -1 if none does
  };
  std::vector<Point<2>> vertices;
  std::vector<Triangle> triangles;
};

/// For parts that do not overlap; they need not conform, nor cover the facet. Corners closer than 1e-11 are
/// identified. Nothing if parts overlap, or leave gaps too narrow to distinguish from rounding.
[[nodiscard]] std::optional<FacetCover> conforming_cover(std::span<const fem::Part<2>> parts);

}  // namespace tribound::certify
