#pragma once

/// @file merged_cells.h
/// Merging of cells where there are too many to display.

#include <cstdint>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/certify/bound/components.h"
#include "tribound/fem/lagrange.h"
#include "tribound/mesh/partition.h"

namespace tribound::adapt
{

/// Cells with the fields on them, as they are sent: in ascending order of their names, concatenated.
template <int dim>
struct FieldCells
{
  std::vector<mesh::CellRecord<dim>> cells;
  std::vector<double> u;                             ///< at the nodes of the cells, as in fem::cell_values()
  std::vector<double> stress;                        ///< coefficients, as in certify::Stress; empty: none
  std::vector<certify::BoundComponents> components;  ///< empty: none
};

/// Merges pairs of cells that come from the bisection of one cell, the smallest first, until all ranks
/// together have at most `most`; returns whether they do. Cells at the boundary stay, and so do pairs shared
/// by two ranks. Of u the interpolant remains, of the stress its mean, of the components the root of the sum
/// of squares. All ranks call it together.
template <int dim>
[[nodiscard]] bool merge_cells(const Ranks& ranks, const fem::LagrangeBasis<dim>& basis, std::int64_t most,
                               FieldCells<dim>& fields);

}  // namespace tribound::adapt
