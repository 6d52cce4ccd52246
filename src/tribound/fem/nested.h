#pragma once

/// @file nested.h
/// Transfers functions to a space that contains theirs.

#include <cstddef>
#include <span>
#include <vector>

#include "tribound/fem/space.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/refine.h"

namespace tribound::fem
{

/// The reference coordinates of x in a cell.
template <int dim>
[[nodiscard]] Point<dim> reference_point(const mesh::CellMap<dim>& map, const Point<dim>& x)
{
  return map.inverse_transpose.transpose() * (x - map.origin);
}

/// The degrees of freedom of u, a function of `coarse`, in `fine`, a space on a mesh nested in that of
/// `coarse`: cell c of `fine` lies in cell parent[c] of `coarse`. Exact up to round-off where the degree of
/// `fine` is not below that of `coarse`. For Bisected, `parent` is its member.
template <int dim>
[[nodiscard]] std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse,
                                                     std::span<const double> u, std::span<const Index> parent,
                                                     const LagrangeSpace<dim>& fine);

/// The values of u at the nodes of cells nested in own cells of a mesh, cell by cell,
/// [(cell n_nodes + i) dim + component]. The nodes are those of the basis of the space on the vertices of the
/// record; cells[c] lies in cell parent[c]. The values can travel with the cells.
template <int dim>
[[nodiscard]] std::vector<double> nested_values(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                                std::span<const mesh::CellRecord<dim>> cells,
                                                std::span<const Index> parent);

/// The values at the nodes of cells of the mesh itself, in the same order.
template <int dim>
[[nodiscard]] std::vector<double> cell_values(const LagrangeSpace<dim>& space, std::span<const double> u,
                                              std::span<const Index> cells);

/// n_each numbers per cell, cell by cell.
struct CellColumn
{
  std::span<const double> values;
  std::size_t n_each;
};
/// Columns side by side: for every cell the numbers of the first column, then those of the next, to travel
/// with the cell.
[[nodiscard]] std::vector<double> beside_each_other(std::span<const CellColumn> columns, std::size_t n_cells);
/// A column of them: for every cell, n_each of its `width` numbers, from `first` on.
[[nodiscard]] std::vector<double> cell_column(std::span<const double> values, std::size_t width,
                                              std::size_t first, std::size_t n_each);

/// The function with these values on all own cells, which are cells[0], cells[1], .... All ranks call it
/// together, and their values agree at common nodes.
template <int dim>
[[nodiscard]] std::vector<double> from_cell_values(const LagrangeSpace<dim>& space,
                                                   std::span<const Index> cells,
                                                   std::span<const double> values);

/// nested_interpolant() for a mesh refined uniformly.
template <int dim>
[[nodiscard]] std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse,
                                                     std::span<const double> u,
                                                     const mesh::Refined<dim>& refined,
                                                     const LagrangeSpace<dim>& fine);

}  // namespace tribound::fem
