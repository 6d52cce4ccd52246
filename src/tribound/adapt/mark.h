#pragma once

/// @file mark.h
/// Which cells to refine, from the bound of each cell.

#include <span>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/base/types.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/mesh/cell_name.h"

namespace tribound::adapt
{

enum class Marking
{
  doerfler,
  maximum,
  uniform  ///< every cell
};

struct MarkingOptions
{
  Marking strategy = Marking::doerfler;
  double theta = 0.6;             ///< in (0, 1]
  bool separate_contact = false;  ///< for the body and for the contact conditions apart, each by its share
};

/// The ranks that mark together, each some of its own cells. `names` of these ascend; on one rank they may be
/// missing, as the numbers of the cells ascend alike.
struct Markers
{
  Ranks ranks{};
  std::span<const mesh::CellName> names{};
};

/// The smallest set of cells with sum eta_T^2 >= theta^2 sum_all eta_T^2 [Doerfler96], over all ranks; of
/// cells whose eta_T agree to 1e-9, and hence up to the rounding of another number of ranks, those with the
/// lower names. Ascending; empty where every eta_T is 0. `eta`: per own cell, finite and not negative; 0 <
/// theta <= 1. O(n log n).
[[nodiscard]] std::vector<Index> mark_doerfler(std::span<const double> eta, double theta,
                                               const Markers& markers = {});

/// The cells with eta_T >= theta max eta_T, up to 1e-9 of it, ascending; empty where every eta_T is 0.
/// Arguments as above.
[[nodiscard]] std::vector<Index> mark_maximum(std::span<const double> eta, double theta,
                                              const Markers& markers = {});

/// All cells 0, ..., n_cells - 1, whatever their share: uniform refinement.
[[nodiscard]] std::vector<Index> mark_all(std::size_t n_cells);

/// As adapt.marking and adapt.theta ask for, by eta_T = total_sharp of every cell. With
/// adapt.separate_contact the union of what body() and contact() mark, each for itself; a part whose square
/// is below a hundredth of the bound's is left to the other.
[[nodiscard]] std::vector<Index> mark(std::span<const certify::BoundComponents> cells,
                                      const MarkingOptions& options, const Markers& markers = {});

/// The same by one number per cell, eta_T^2, without parts that could be separate.
[[nodiscard]] std::vector<Index> mark(std::span<const double> squares, const MarkingOptions& options,
                                      const Markers& markers = {});

}  // namespace tribound::adapt
