#pragma once

/// @file mark.h
/// Which cells to refine, from their contributions to the bound.

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
  bool separate_contact = false;  ///< marks by the body and by the contact conditions separately
};

/// The ranks that mark together, each some of its own cells. `names` of these are in ascending order. They
/// may be omitted on one rank, where the numbers of the cells have the same order.
struct Markers
{
  Ranks ranks{};
  std::span<const mesh::CellName> names{};
};

/// The smallest set of cells with sum eta_T^2 >= theta^2 sum_all eta_T^2 [Doerfler96], over all ranks. Cells
/// whose eta_T agree to 1e-9, hence up to rounding on another number of ranks, are taken in the order of
/// their names. Ascending; empty where every eta_T is 0. `eta`: per own cell, finite and not negative; 0 <
/// theta <= 1. O(n log n).
[[nodiscard]] std::vector<Index> mark_doerfler(std::span<const double> eta, double theta,
                                               const Markers& markers = {});

/// The cells with eta_T >= theta max eta_T, up to 1e-9 of it, ascending; empty where every eta_T is 0.
/// Arguments as above.
[[nodiscard]] std::vector<Index> mark_maximum(std::span<const double> eta, double theta,
                                              const Markers& markers = {});

/// All cells 0, ..., n_cells - 1, whatever their share: uniform refinement.
[[nodiscard]] std::vector<Index> mark_all(std::size_t n_cells);

/// Marks according to adapt.marking and adapt.theta, by eta_T = total_sharp of every cell. With
/// adapt.separate_contact it is the union of the cells marked by body() and by contact() separately. A part
/// whose square is below a hundredth of the bound's is ignored.
[[nodiscard]] std::vector<Index> mark(std::span<const certify::BoundComponents> cells,
                                      const MarkingOptions& options, const Markers& markers = {});

/// The same by one number per cell, eta_T^2, without separate parts.
[[nodiscard]] std::vector<Index> mark(std::span<const double> squares, const MarkingOptions& options,
                                      const Markers& markers = {});

}  // namespace tribound::adapt
