#pragma once

/// @file merged_cells.h
/// Cells that are put together again where there are too many to be shown.

#include <cstdint>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/certify/bound/components.h"
#include "tribound/fem/lagrange.h"
#include "tribound/mesh/partition.h"

namespace tribound::adapt
{

/// Cells with the fields on them, as they travel: in ascending order of their names, one behind the other.
template <int dim>
struct FieldCells
{
  std::vector<mesh::CellRecord<dim>> cells;
  std::vector<double> u;       ///< at the nodes of the cells, as fem::cell_values() has it
  std::vector<double> stress;  ///< coefficients, as certify::Stress has them; empty: none
  std::vector<certify::BoundComponents> components;  ///< empty: none
};

/// Puts pairs of cells together that bisection has made of one, the smallest first, until all ranks together
/// have at most `most`; whether they come to that. Cells at the boundary stay, and pairs of which a rank has
/// one. Of u the interpolant remains, of the stress its mean, of the components the root of the sum of their
/// squares. All ranks call it together.
template <int dim>
[[nodiscard]] bool merge_cells(const Ranks& ranks, const fem::LagrangeBasis<dim>& basis, std::int64_t most,
                               FieldCells<dim>& fields);

}  // namespace tribound::adapt
