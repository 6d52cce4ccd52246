#pragma once

/// @file report.h
/// The report of a run. Plain data in, text out; what is unknown is absent, never zero.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/path_program.h"
#include "tribound/certify/bound/certificate.h"
#include "tribound/doctor/findings.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/history_check.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// The levels before a restart, as text. For a run over a history, the completed passes and the load steps of
/// the current pass.
struct EarlierLevels
{
  std::string convergence{};     ///< convergence.csv
  std::string newton{};          ///< newton.csv
  std::string levels = "[]";     ///< `levels` of certificate.json
  std::int64_t first_cells = 0;  ///< of the first mesh
  std::string history{};         ///< history.csv
  std::string steps{};           ///< `steps` of certificate.json; empty without a history
  /// The worst of those steps in the form of convergence.csv and `levels`, should it be that of the pass.
  std::string worst_convergence{};
  std::string worst_level{};
};

/// A load step as in the tables and the certificate: lines of history.csv and newton.csv without the column
/// names, and its entry in `steps`.
struct StepRows
{
  std::string history{};
  std::string newton{};
  std::string record{};
};

struct RunRecord
{
  CaseFacts facts;
  MeshFacts mesh;  ///< the first mesh
  BuildFacts build;
  certify::RunStatus status = certify::RunStatus::uncertified;
  std::string reason;  ///< why the run is not certified, or what failed; empty when certified
  EarlierLevels earlier;
  std::vector<LevelRecord> levels;    ///< after them; for a history, the load steps of the last pass
  std::vector<LevelRecord> passes;    ///< for a history: the worst step on each mesh
  adapt::PathEnd path;                ///< for a history: its outcome in that pass
  std::optional<HistoryCheck> check;  ///< for a history, where requested
  double tolerance = 0.0;             ///< of bound / ||sigma(u_h)||
  certify::Statements statements;
  std::vector<doctor::Finding> warnings;  ///< about the last level
  EffectiveCase effective;                ///< empty where the run is part of a larger one
  std::string case_file = "case.toml";    ///< its name in the output directory
  double setup = 0.0;                     ///< wall time before the first level; s
};

/// Whether the run has load steps.
[[nodiscard]] bool has_history(const RunRecord& run);

/// All levels of the run as earlier ones.
[[nodiscard]] EarlierLevels as_earlier(const RunRecord& run);
/// For a history: the completed passes, the worst step of the current pass number `pass`, and the tables
/// without the rows of its load steps. add_steps() adds these, so the data stored per load step are those of
/// one step.
[[nodiscard]] EarlierLevels as_earlier(const RunRecord& run, int pass, int worst_step);
/// The last load step of this run.
[[nodiscard]] StepRows last_step_rows(const RunRecord& run);
void add_steps(EarlierLevels& earlier, std::span<const StepRows> steps);

/// For a history, at the start of another pass: keeps only the completed passes.
void drop_steps(EarlierLevels& earlier);

/// For a history: the pass is complete, and this step, possibly an earlier one, is its worst.
void complete_pass(RunRecord& run, int pass, int worst_step);

/// The last load step, if from an earlier run only what later steps build on; nothing where there is none.
[[nodiscard]] std::optional<LoadStepRecord> last_load_step(const RunRecord& run);

/// The tables including the earlier levels.
[[nodiscard]] std::string convergence_csv(const RunRecord& run);
[[nodiscard]] std::string history_csv(const RunRecord& run);
[[nodiscard]] std::string newton_csv(const RunRecord& run);

/// The text of certificate.json, see docs/output.md; unknown numbers are null.
[[nodiscard]] std::string certificate_json(const RunRecord& run);

/// Whether the certificate in the directory has a history check.
[[nodiscard]] bool has_history_check(const std::filesystem::path& directory);
/// Adds the check of the run to it; nothing else changes. Does nothing where there is no certificate. Throws
/// WriteError.
void add_history_check(const std::filesystem::path& directory, const RunRecord& run);

/// Writes the effective case, convergence.csv, newton.csv, where there is something for them history.csv,
/// quantities.csv, probes.csv and sections.csv, and, last, certificate.json. Throws WriteError when a file
/// cannot be written.
void write_report(const std::filesystem::path& directory, const RunRecord& run);

}  // namespace tribound::io
