#pragma once

/// @file page_volume.h
/// The inside of a body in 3D for the report page, which cuts it by planes.

#include <cstddef>
#include <span>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::app
{

/// Tetrahedra with values at their vertices; stresses, which jump, are averaged there by volume.
struct Volume
{
  std::vector<double> points;               ///< 3 coordinates per vertex
  std::vector<double> displacement;         ///< 3 components per vertex
  std::vector<std::vector<double>> stress;  ///< sigma_h: xx, yy, zz, xy, yz, xz
  std::vector<Index> cells;                 ///< 4 vertices per cell
  std::vector<Index> bodies;                ///< per vertex: the body it belongs to
};

/// Cells up to which a page has them; beyond, it shows the surface alone.
inline constexpr std::size_t max_volume_cells = 40'000;

[[nodiscard]] Volume sample_volume(const contact::NitscheForm<3>& form, std::span<const double> u,
                                   const certify::Stress<3>& stress);

}  // namespace tribound::app
