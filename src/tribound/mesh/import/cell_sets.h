#pragma once

/// @file cell_sets.h
/// Sets of cells as regions.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// The set of every cell, of a mesh whose sets are disjoint; -1: none.
[[nodiscard]] std::vector<Index> set_of_cells(const ImportedMesh& mesh);

/// The number of a cell in the file.
[[nodiscard]] std::int64_t number_of_cell(const ImportedMesh& mesh, Index cell);

/// Whether no cell of 0 ... n - 1 is in two sets, nor twice in one.
[[nodiscard]] bool are_disjoint(std::span<const CellSet> sets, std::size_t n);

/// The sets that are not empty, if they have each of n cells once; where others are left, without those that
/// have all cells. Nothing if they do not.
[[nodiscard]] std::vector<CellSet> partition_of(std::vector<CellSet> sets, std::size_t n);

/// Why they are no partition: "element 5 is in "a" and in "b"", or in none; `number`: that of a cell in the
/// file.
[[nodiscard]] std::string fault_of_partition(std::span<const CellSet> sets, std::size_t n,
                                             const std::function<std::int64_t(Index)>& number);

}  // namespace tribound::mesh
