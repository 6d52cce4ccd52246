#pragma once

/// @file checkpoint.h
/// What a run needs to go on with its next level or load step, in a file: checkpoint.h5.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/levels.h"
#include "tribound/base/ranks.h"
#include "tribound/io/record/report.h"
#include "tribound/io/state/step_log.h"
#include "tribound/mesh/partition.h"

namespace tribound::io
{

inline constexpr const char* checkpoint_name = "checkpoint.h5";
/// "checkpoint_007.h5", of a load step.
[[nodiscard]] std::string checkpoint_name_of(int step);

/// What is the same on all ranks.
struct CheckpointFacts
{
  int dimension = 0;
  int degree = 0;
  adapt::LevelStart start{};
  std::string case_text{};  ///< the effective case
  EarlierLevels earlier{};  ///< the tables up to here
  LoggedSteps steps{};      ///< of a run over load steps: their rows, which are in a file of their own
  std::string path{};       ///< of a run over load steps (path_checkpoint.h); else empty
  int n_functions = 1;      ///< CheckpointFields::functions
  int n_cell_values = 0;    ///< CheckpointFields::cell_values, of each cell
};

/// Numbers of a cell: values of functions at its nodes, and others.
[[nodiscard]] int n_values_of_cell(const CheckpointFacts& facts);

/// What a checkpoint has beside the mesh.
struct CheckpointFields
{
  std::vector<std::span<const double>> functions{};  ///< of the space, by degree of freedom
  std::vector<double> cell_values{};                 ///< of own cells, as many of each
  std::vector<double> points{};                      ///< on the first rank: rows of so many numbers
  int point_width = 1;
};

/// The cells that a rank reads, in no particular order, with their numbers.
template <int dim>
struct CheckpointCells
{
  std::vector<mesh::CellRecord<dim>> cells;
  std::vector<double> values;  ///< n_values_of_cell() of each: function by function, then the others
  std::vector<double> points;  ///< on every rank all
};

/// Writes a checkpoint, in the place of an earlier one when it is complete. All ranks call it together.
/// Throws WriteError.
template <int dim>
void write_checkpoint(const std::filesystem::path& file, const CheckpointFacts& facts,
                      const fem::LagrangeSpace<dim>& space, const CheckpointFields& fields);

/// A file that has the same as one that was written, without writing it again. Throws WriteError.
void copy_checkpoint(const std::filesystem::path& from, const std::filesystem::path& to);

/// All ranks call them together; how many there are does not matter. They throw InputError for a file that is
/// no checkpoint, or that of another version, or whose load steps are missing.
[[nodiscard]] CheckpointFacts read_checkpoint_facts(const std::filesystem::path& file, const Ranks& ranks);
template <int dim>
[[nodiscard]] CheckpointCells<dim> read_checkpoint_cells(const std::filesystem::path& file,
                                                         const CheckpointFacts& facts, const Ranks& ranks);

}  // namespace tribound::io
