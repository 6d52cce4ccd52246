#pragma once

/// @file tables.h
/// What the tables say of a level and of a Newton step: columns with the names of docs/output.md.

#include <span>
#include <string>
#include <vector>

#include "tribound/io/file/csv.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// Size, Newton steps and bound: what every table of levels begins with.
[[nodiscard]] TableRow level_columns(const LevelRecord& level);

/// What the tables have at the end: of a regularised run its components and delta, of one with pairs what
/// passes between meshes.
[[nodiscard]] TableRow further_columns(const LevelRecord& level, const certify::RunKind& kind);

/// A row per level; of passes over a history with the number of the step that it is of.
[[nodiscard]] std::string convergence_csv(std::span<const LevelRecord> levels);
/// A row per load step.
[[nodiscard]] std::string history_csv(std::span<const LevelRecord> steps);

/// A row per Newton step of every level; of a step without a bound it has the components that are known.
[[nodiscard]] std::vector<TableRow> newton_rows(std::span<const LevelRecord> levels);
[[nodiscard]] std::string newton_csv(std::span<const LevelRecord> levels);

}  // namespace tribound::io
