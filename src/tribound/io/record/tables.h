#pragma once

/// @file tables.h
/// The columns of the tables for a level and for a Newton step, with the names of docs/output.md.

#include <span>
#include <string>
#include <vector>

#include "tribound/io/file/csv.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// Size, Newton steps and bound: the first columns of every table of levels.
[[nodiscard]] TableRow level_columns(const LevelRecord& level);

/// The last columns of the tables: for a regularised run its components and delta, for one with pairs the
/// components of the transfer between meshes.
[[nodiscard]] TableRow further_columns(const LevelRecord& level, const certify::RunKind& kind);

/// A row per level; for passes over a history with the number of the worst step.
[[nodiscard]] std::string convergence_csv(std::span<const LevelRecord> levels);
/// A row per load step.
[[nodiscard]] std::string history_csv(std::span<const LevelRecord> steps);

/// A row per Newton step of every level; a step without a bound has the known components.
[[nodiscard]] std::vector<TableRow> newton_rows(std::span<const LevelRecord> levels);
[[nodiscard]] std::string newton_csv(std::span<const LevelRecord> levels);

}  // namespace tribound::io
