#pragma once

/// @file report.h
/// What a run is reported by. Plain data in, text out; what is not known is absent, never zero.

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

/// The levels before a restart, as text; of a run over a history the passes that were complete, and the load
/// steps of the pass in work.
struct EarlierLevels
{
  std::string convergence{};     ///< convergence.csv
  std::string newton{};          ///< newton.csv
  std::string levels = "[]";     ///< `levels` of certificate.json
  std::int64_t first_cells = 0;  ///< of the first mesh
  std::string history{};         ///< history.csv
  std::string steps{};           ///< `steps` of certificate.json; empty without a history
  /// The worst of those steps as convergence.csv and `levels` have it when it is that of the pass.
  std::string worst_convergence{};
  std::string worst_level{};
};

/// A load step as the tables and the certificate have it: lines of history.csv and newton.csv without the
/// first, which names the columns, and its place in `steps`.
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
  std::vector<LevelRecord> levels;    ///< after them; of a run over a history its load steps in the last pass
  std::vector<LevelRecord> passes;    ///< over a history: the worst step on each mesh
  adapt::PathEnd path;                ///< over a history: what came of it in that pass
  std::optional<HistoryCheck> check;  ///< over a history, where it was asked for
  double tolerance = 0.0;             ///< of bound / ||sigma(u_h)||
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
/// Over a history: the passes that are complete, the worst step of pass number `pass`, which is in work, and
/// the columns of the tables without the rows of its load steps, which add_steps() adds: what is made of each
/// load step is of the size of one.
[[nodiscard]] EarlierLevels as_earlier(const RunRecord& run, int pass, int worst_step);
/// The last load step of this run.
[[nodiscard]] StepRows last_step_rows(const RunRecord& run);
void add_steps(EarlierLevels& earlier, std::span<const StepRows> steps);

/// Over a history, when another pass begins: the complete passes alone stay.
void drop_steps(EarlierLevels& earlier);

/// Over a history: that pass is complete, and this step, which may be an earlier one, its worst.
void complete_pass(RunRecord& run, int pass, int worst_step);

/// Its last load step, of an earlier one what the steps after it add to; nothing where there is none.
[[nodiscard]] std::optional<LoadStepRecord> last_load_step(const RunRecord& run);

/// The tables with the earlier levels.
[[nodiscard]] std::string convergence_csv(const RunRecord& run);
[[nodiscard]] std::string history_csv(const RunRecord& run);
[[nodiscard]] std::string newton_csv(const RunRecord& run);

/// The text of certificate.json, see docs/output.md; unknown numbers are null.
[[nodiscard]] std::string certificate_json(const RunRecord& run);

/// Whether the certificate in the directory has one.
[[nodiscard]] bool has_history_check(const std::filesystem::path& directory);
/// Adds that of the run to it; nothing else changes. Does nothing where there is no certificate. Throws
/// WriteError.
void add_history_check(const std::filesystem::path& directory, const RunRecord& run);

/// Writes the effective case, convergence.csv, history.csv where there are load steps, newton.csv and
/// certificate.json, the last one last. Throws
/// WriteError when a file cannot be written.
void write_report(const std::filesystem::path& directory, const RunRecord& run);

}  // namespace tribound::io
