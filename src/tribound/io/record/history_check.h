#pragma once

/// @file history_check.h
/// What is written of a path that was followed once more (adapt/history_check.h), as plain data.

#include <cstdint>
#include <optional>
#include <vector>

#include "tribound/adapt/path_program.h"
#include "tribound/io/record/load_step_record.h"
#include "tribound/problem/units.h"

namespace tribound::io
{

struct HistoryCheck
{
  std::int64_t cells = 0;                ///< of its mesh
  int steps = 0;                         ///< that it has come to
  std::optional<LoadStepRecord> last{};  ///< of these
  adapt::PathEnd end{};                  ///< with a failure there is nothing to compare
};

/// A figure of the path and of the check; absent where a path has none.
struct ComparedFigure
{
  const char* name;  ///< in certificate.json
  const char* word;  ///< on the screen
  std::optional<double> path{};
  std::optional<double> check{};
  std::optional<problem::UnitOf> unit{};  ///< absent: a pure number

  /// check - path, where both are there.
  [[nodiscard]] std::optional<double> difference() const;
};

/// t of the peak and, of the last step of either path, t, N_eff = integral of T^n + p_w, the tangential
/// resultant, and what has been dissipated: both end by the same rule, at the last t, when enough is damaged
/// or at the displacement that is asked for, so that their ends belong together. `end`, `last`: of the path.
/// Empty where the check has failed.
[[nodiscard]] std::vector<ComparedFigure> compare(const adapt::PathEnd& end, const LoadStepRecord& last,
                                                  const HistoryCheck& check);

/// What it is, and what it does not promise.
[[nodiscard]] const char* words_of_check();

}  // namespace tribound::io
