#pragma once

/// @file checkpoint.h
/// What a run needs to go on with its next level, in a file: checkpoint.h5.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/levels.h"
#include "tribound/base/ranks.h"
#include "tribound/io/record/report.h"
#include "tribound/mesh/partition.h"

namespace tribound::io
{

inline constexpr const char* checkpoint_name = "checkpoint.h5";

/// What is the same on all ranks.
struct CheckpointFacts
{
  int dimension = 0;
  int degree = 0;
  adapt::LevelStart start;
  std::string case_text;  ///< the effective case
  EarlierLevels earlier;  ///< the tables up to here
};

/// The cells that a rank reads, in no particular order, with the values of u at their nodes.
template <int dim>
struct CheckpointCells
{
  std::vector<mesh::CellRecord<dim>> cells;
  std::vector<double> values;
};

/// Writes checkpoint.h5 in the directory, in the place of an earlier one when it is complete. `u` belongs
/// to `space`. All ranks call it together. Throws WriteError.
template <int dim>
void write_checkpoint(const std::filesystem::path& directory, const CheckpointFacts& facts,
                      const fem::LagrangeSpace<dim>& space, std::span<const double> u);

/// All ranks call them together; how many there are does not matter. They throw InputError for a file that is
/// no checkpoint, or that of another version.
[[nodiscard]] CheckpointFacts read_checkpoint_facts(const std::filesystem::path& directory,
                                                    const Ranks& ranks);
template <int dim>
[[nodiscard]] CheckpointCells<dim> read_checkpoint_cells(const std::filesystem::path& directory,
                                                         const CheckpointFacts& facts, const Ranks& ranks);

}  // namespace tribound::io
