#pragma once

/// @file run.h
/// A run whose case and mesh have been read.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/command/commands.h"
#include "app/command/level_files.h"
#include "app/console/console.h"
#include "tribound/case/config.h"
#include "tribound/io/state/checkpoint.h"
#include "tribound/mesh/mesh.h"

namespace tribound::app
{

[[nodiscard]] ExitCode exit_code(certify::RunStatus status);

/// Data of a run that continues another one.
struct Restart
{
  io::CheckpointFacts facts;
  std::vector<Index> cells;    ///< of the mesh, in the order of their values
  std::vector<double> values;  ///< as in io::CheckpointCells
  std::vector<double> points;
  bool is_apart =
      false;  ///< whether it is in a pass after the first, whose files are separate until it is complete
  std::filesystem::path file{};  ///< the checkpoint
};

/// What a program adds to a run on meshes of one dimension; each may be empty. Levels are kept by what is
/// passed.
template <int dim>
struct LoopHooks
{
  using Level = std::shared_ptr<const KeptLevel<dim>>;

  std::function<std::vector<Index>(const Level&)> mark{};  ///< in place of the marking of the case
  /// Why a level is the last, besides the limits of the case; empty: it is not.
  std::function<std::string(const Level&)> stop{};
  /// Called after every level that has a bound, a second time for the last one where LoopObserver::level is,
  /// and after every load step.
  std::function<void(const Level&, const io::LevelRecord&)> level{};
};

/// What a program adds to a run.
struct RunHooks
{
  adapt::StepObserver step{};
  std::function<void(case_file::Config&)> change{};  ///< the case, before anything is done with it
  std::function<void()> pass{};  ///< called when the load steps so far are those of a complete pass
  bool is_part = false;          ///< of a larger command, which says how it ends
  LoopHooks<2> plane{};
  LoopHooks<3> space{};

  template <int dim>
  [[nodiscard]] const LoopHooks<dim>& of() const
  {
    if constexpr (dim == 2)
      return plane;
    else
      return space;
  }
  template <int dim>
  [[nodiscard]] LoopHooks<dim>& of()
  {
    if constexpr (dim == 2)
      return plane;
    else
      return space;
  }
};

/// Runs the adaptive algorithm on the case, or follows its load steps on meshes that become fine enough for
/// all of them, and writes the results on the way. On several ranks all call it, each with its part of the
/// mesh, and the first also with the `whole` first mesh or an equivalent one, see adapt::Levels. With
/// `restart` the mesh is that of a later level or load step. Throws InputError, SolveError and WriteError.
template <int dim>
[[nodiscard]] ExitCode run(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress,
                           const RunHooks& hooks, std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr,
                           const Restart* restart = nullptr);

}  // namespace tribound::app
