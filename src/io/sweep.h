#pragma once

/// @file sweep.h
/// What `tribound sweep` leaves: sweep.csv and sweep.json, a row for each run, from the certificates of the
/// runs.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tribound
{

/// One run of a sweep. Numbers that are not known are absent.
struct SweepRun
{
  std::string name;                 ///< of its directory: "0001"
  std::vector<std::string> values;  ///< a value per key
  std::string sha256;               ///< of its effective case
  std::optional<int> exit_code;     ///< absent while it has not ended; 128 + n for signal n
  std::string status;               ///< of its certificate; "not run", "bad input" and "crashed" without one
  std::string reason;
  /// In the order in which they were found: relative, bound, cells, dofs, ...; see docs/output.md.
  std::vector<std::pair<std::string, std::optional<double>>> figures;
};

struct SweepRecord
{
  std::string title;
  std::string file;
  std::vector<std::string> keys;
  std::vector<SweepRun> runs;
};

/// Status, reason and figures of a run that has ended, from certificate.json and contact.csv in its
/// directory.
void read_results(const std::filesystem::path& directory, SweepRun& run);

/// Whether a run of an earlier sweep in this directory, as its sweep.json has it, is complete and solved the
/// same effective case; then its exit code.
[[nodiscard]] std::map<std::string, int> complete_runs(const std::filesystem::path& directory,
                                                       const SweepRecord& sweep);

/// A row per run: name, the keys, status, reason, then every figure that some run has.
[[nodiscard]] std::string sweep_csv(const SweepRecord& sweep);
[[nodiscard]] std::string sweep_json(const SweepRecord& sweep);

/// Writes sweep.csv and sweep.json. Throws InputError when a file cannot be written.
void write_sweep(const std::filesystem::path& directory, const SweepRecord& sweep);

/// A line on a run that has ended.
[[nodiscard]] std::string sweep_line(const SweepRecord& sweep, const SweepRun& run);

}  // namespace tribound
