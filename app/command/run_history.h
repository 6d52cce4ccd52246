#pragma once

/// @file run_history.h
/// `tribound run` of a case with load steps.

#include <atomic>
#include <memory>
#include <vector>

#include "app/command/run.h"

namespace tribound::app
{

/// Follows the load steps of the case, which has some, on meshes that become fine enough for all of them, and
/// writes the results; otherwise as run(). `slides`: doctor::slides_as_a_whole(); the run began at `begin`.
template <int dim>
[[nodiscard]] ExitCode run_history(const case_file::Config& config, const problem::Problem<dim>& problem,
                                   mesh::Mesh<dim> mesh, std::vector<bool> slides,
                                   const std::atomic<bool>& stop, const Progress& progress,
                                   std::shared_ptr<const mesh::Mesh<dim>> whole,
                                   const std::optional<Restart>& restart, Clock::time_point begin);

}  // namespace tribound::app
