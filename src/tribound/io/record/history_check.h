#pragma once

/// @file history_check.h
/// Output of the check of a path (adapt/history_check.h), as plain data.

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
  int steps = 0;                         ///< number of steps followed
  std::optional<LoadStepRecord> last{};  ///< of these steps
  adapt::PathEnd end{};                  ///< after a failure there is nothing to compare
};

/// A figure of the path and of the check; absent where either has none.
struct ComparedFigure
{
  const char* name;  ///< in certificate.json
  const char* word;  ///< on the screen
  std::optional<double> path{};
  std::optional<double> check{};
  std::optional<problem::UnitOf> unit{};  ///< absent: a pure number

  /// check - path, where both exist.
  [[nodiscard]] std::optional<double> difference() const;
};

/// Compares t of the peak and, at the last step of either path, t, N_eff = integral of T^n + p_w, the
/// tangential resultant, and the dissipation. Both paths end by the same rule, at the last t, when enough is
/// damaged or at the prescribed displacement, so their ends correspond. `end`, `last`: of the path. Empty
/// where the check has failed.
[[nodiscard]] std::vector<ComparedFigure> compare(const adapt::PathEnd& end, const LoadStepRecord& last,
                                                  const HistoryCheck& check);

/// What the check is, and what it does not guarantee.
[[nodiscard]] const char* words_of_check();

}  // namespace tribound::io
