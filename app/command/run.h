#pragma once

/// @file run.h
/// The commands of the program on one case.

#include <filesystem>
#include <optional>
#include <vector>

#include "app/console/console.h"
#include "tribound/adapt/levels.h"
#include "tribound/base/clock.h"
#include "tribound/case/config.h"
#include "tribound/io/state/checkpoint.h"
#include "tribound/mesh/mesh.h"

namespace tribound::app
{

/// Exit codes, a contract with scripts.
enum class ExitCode
{
  success = 0,        ///< certified: the identities hold, the tolerance is reached
  bad_input = 1,      ///< InputError
  failed = 2,         ///< no convergence, singular matrix, identity violated, a result not written
  budget_used_up = 3  ///< the certificate is valid, the tolerance is not reached
};

[[nodiscard]] ExitCode exit_code(certify::RunStatus status);

/// A run that goes on where another one was.
struct Restart
{
  io::CheckpointFacts facts;
  std::vector<Index> cells;    ///< of the mesh, in the order of their values
  std::vector<double> values;  ///< as io::CheckpointCells has them
  std::vector<double> points;
  std::filesystem::path file;
};

/// Runs the adaptive algorithm on the case and writes the results, level by level; on several ranks all call
/// it, each with its part of the mesh, and the first with the `whole` first mesh or one like it, see
/// adapt::Levels. With `restart` the mesh is that of a later level. Throws InputError, SolveError and
/// WriteError.
template <int dim>
[[nodiscard]] ExitCode run(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress,
                           std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr,
                           const std::optional<Restart>& restart = {});

/// Reads and verifies everything `run` would, and prints a summary with what the doctor finds, for people or
/// as JSON.
template <int dim>
void check(const case_file::Config& config, const mesh::Mesh<dim>& mesh, bool as_json);

}  // namespace tribound::app
