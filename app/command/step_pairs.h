#pragma once

/// @file step_pairs.h
/// The steps of other programs' files, and the load steps of a case that they belong to.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command/commands.h"
#include "tribound/mesh/import/imported_solution.h"

namespace tribound::app
{

/// A step of theirs.
struct TheirStep
{
  std::string file;
  std::optional<mesh::SolutionStep> step{};          ///< nothing: the file has one step
  std::optional<mesh::ImportedSolution> solution{};  ///< where it has been read
};

/// All steps of the files of a request, in their order. Throws InputError.
[[nodiscard]] std::vector<TheirStep> all_steps(const JudgeRequest& request);

/// For each load step of a case, with these values of t, the place of the step of theirs: that with the same
/// t, if every load step has one; else one after the other, if there are as many. Throws InputError with both
/// lists for others, and where times that are not 1, 2, ... contradict the order.
[[nodiscard]] std::vector<std::size_t> pair_steps(std::span<const double> load_steps,
                                                  std::span<const TheirStep> theirs);

}  // namespace tribound::app
