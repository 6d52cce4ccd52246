#pragma once

/// @file report.h
/// What a run is reported by. Plain data in, text out; what is not known is absent, never zero.

#include <filesystem>
#include <string>
#include <vector>

#include "tribound/adapt/path_program.h"
#include "tribound/certify/bound/certificate.h"
#include "tribound/doctor/findings.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// The levels before a restart, as text.
struct EarlierLevels
{
  std::string convergence;       ///< rows of convergence.csv
  std::string newton;            ///< rows of newton.csv
  std::string levels = "[]";     ///< `levels` of certificate.json
  std::int64_t first_cells = 0;  ///< of the first mesh
};

struct RunRecord
{
  CaseFacts facts;
  MeshFacts mesh;  ///< the first mesh
  BuildFacts build;
  certify::RunStatus status = certify::RunStatus::uncertified;
  std::string reason;  ///< why the run is not certified, or what failed; empty when certified
  EarlierLevels earlier;
  std::vector<LevelRecord> levels;  ///< after them; of a run over a history its load steps in the last pass
  std::vector<LevelRecord> passes;  ///< over a history: the worst step on each mesh
  adapt::PathEnd path;              ///< over a history: what came of it in that pass
  double tolerance = 0.0;           ///< of bound / ||sigma(u_h)||
  certify::Statements statements;
  std::vector<doctor::Finding> warnings;  ///< about the last level
  EffectiveCase effective;                ///< empty where the run is a part of something larger
  std::string case_file = "case.toml";    ///< where it is written in the output directory
  double setup = 0.0;                     ///< wall time before the first level; s
};

/// Whether it goes through load steps.
[[nodiscard]] bool has_history(const RunRecord& run);

/// All its levels as earlier ones.
[[nodiscard]] EarlierLevels as_earlier(const RunRecord& run);

/// The tables with the earlier levels.
[[nodiscard]] std::string convergence_csv(const RunRecord& run);
[[nodiscard]] std::string newton_csv(const RunRecord& run);

/// The text of certificate.json, see docs/output.md; unknown numbers are null.
[[nodiscard]] std::string certificate_json(const RunRecord& run);

/// Writes the effective case, convergence.csv, history.csv where there are load steps, newton.csv and
/// certificate.json, the last one last. Throws
/// WriteError when a file cannot be written.
void write_report(const std::filesystem::path& directory, const RunRecord& run);

}  // namespace tribound::io
