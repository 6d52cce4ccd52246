#pragma once

/// @file report_parts.h
/// What reports of runs are made of, over levels and over load steps.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command/level_files.h"
#include "app/output_directory.h"
#include "tribound/adapt/loop.h"
#include "tribound/base/clock.h"
#include "tribound/case/config.h"
#include "tribound/io/record/report.h"

namespace tribound::app
{

/// What a run says on stdout.
enum class Printed
{
  everything,
  levels,   ///< a line per level, as a part of something larger
  verdict,  ///< status and warnings at the end
  nothing
};

/// Takes the directory of results, and removes what an earlier run has left there, the certificate first.
/// Throws InputError where nothing can be written. On the first rank.
[[nodiscard]] std::unique_ptr<OutputDirectory> take_directory(const case_file::Config& config,
                                                              bool keeps_results);

/// The record of a run on its first mesh, before anything is solved; it began at `begin`.
template <int dim>
[[nodiscard]] io::RunRecord first_record(const case_file::Config& config,
                                         const problem::Problem<dim>& problem,
                                         const fem::LagrangeSpace<dim>& space,
                                         const fem::Constraints& constraints, Clock::time_point begin);

/// The boundaries of the mesh that the case does not mention: they are free.
[[nodiscard]] std::vector<std::string> free_sides(const case_file::Config& config,
                                                  std::span<const std::string> boundary_names);

/// What the first rank shows of a level whose owner keeps it as `kept`: that, or of several ranks their cells
/// put together; null on the others.
template <int dim>
[[nodiscard]] std::shared_ptr<const KeptLevel<dim>> gather(const adapt::LevelView<dim>& view,
                                                           std::shared_ptr<const KeptLevel<dim>> kept,
                                                           const case_file::OutputConfig& output,
                                                           const adapt::Method& method);

/// Whether the page can show what the first rank has of a level.
template <int dim>
[[nodiscard]] bool fits_page(const KeptLevel<dim>& shown);

/// contact.csv, and the mesh as adapted.msh where it is wanted.
template <int dim>
void write_contact_and_mesh(const KeptLevel<dim>& shown, const case_file::OutputConfig& output,
                            const std::vector<std::string>& free_sides);

/// The fields of a level as VTU files, and of what is `shown` of it, unless null, the contact boundary.
template <int dim>
void write_vtu_files(const std::filesystem::path& directory, const KeptLevel<dim>& level,
                     const KeptLevel<dim>* shown);

/// What is said at the end of a run.
void print_end(const io::RunRecord& record, Printed printed, const std::filesystem::path& directory);

/// What the certificate says about the level: its data, and how its systems were solved.
template <int dim>
void update_statements(io::RunRecord& record, const adapt::LevelView<dim>& view, certify::ContactRule rule);

/// Warnings about the last level of the record; `shown`: gather().
template <int dim>
void update_warnings(io::RunRecord& record, const adapt::LevelView<dim>& view, const KeptLevel<dim>* shown);

}  // namespace tribound::app
