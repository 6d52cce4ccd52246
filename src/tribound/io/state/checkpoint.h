#pragma once

/// @file checkpoint.h
/// The data that a run needs to continue with its next level or load step, in a file: checkpoint.h5.

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
/// "checkpoint_007.h5", for a load step.
[[nodiscard]] std::string checkpoint_name_of(int step);

/// The data that are the same on all ranks.
struct CheckpointFacts
{
  int dimension = 0;
  int degree = 0;
  adapt::LevelStart start{};
  std::string case_text{};  ///< the effective case
  EarlierLevels earlier{};  ///< the tables so far
  LoggedSteps steps{};      ///< for load steps: their rows, which are in a separate file
  std::string path{};       ///< for load steps (path_checkpoint.h); else empty
  int n_functions = 1;      ///< CheckpointFields::functions
  int n_cell_values = 0;    ///< CheckpointFields::cell_values, per cell
};

/// Number of values per cell: of functions at its nodes, and others.
[[nodiscard]] int n_values_of_cell(const CheckpointFacts& facts);

/// The data of a checkpoint besides the mesh.
struct CheckpointFields
{
  std::vector<std::span<const double>> functions{};  ///< of the space, by degree of freedom
  std::vector<double> cell_values{};                 ///< of own cells, equally many each
  std::vector<double> points{};                      ///< on the first rank: rows of `point_width` numbers
  int point_width = 1;
};

/// The cells read by a rank, in no particular order, with their values.
template <int dim>
struct CheckpointCells
{
  std::vector<mesh::CellRecord<dim>> cells;
  std::vector<double> values;  ///< n_values_of_cell() each: function by function, then the others
  std::vector<double> points;  ///< all of them on every rank
};

/// Writes a checkpoint, which replaces an earlier one once it is complete. All ranks call it together. Throws
/// WriteError.
template <int dim>
void write_checkpoint(const std::filesystem::path& file, const CheckpointFacts& facts,
                      const fem::LagrangeSpace<dim>& space, const CheckpointFields& fields);

/// Makes a file with the same contents as an existing one, without rewriting them if possible. Throws
/// WriteError.
void copy_checkpoint(const std::filesystem::path& from, const std::filesystem::path& to);

/// All ranks call these together; their number may differ from that of the writers. Throw InputError for a
/// file that is no checkpoint, or has another version, or whose load steps are missing.
[[nodiscard]] CheckpointFacts read_checkpoint_facts(const std::filesystem::path& file, const Ranks& ranks);
template <int dim>
[[nodiscard]] CheckpointCells<dim> read_checkpoint_cells(const std::filesystem::path& file,
                                                         const CheckpointFacts& facts, const Ranks& ranks);

}  // namespace tribound::io
