#pragma once

/// @file sweep.h
/// The results of `tribound sweep`: sweep.csv and sweep.json, a row for each run, from the certificates of
/// the runs.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/io/file/json_forward.h"

namespace tribound::app
{

/// One run of a sweep. Unknown numbers are absent.
struct SweepRun
{
  std::string name;                 ///< of its directory: "0001"
  std::vector<std::string> values;  ///< a value per key
  std::string sha256;               ///< of its effective case
  std::string files_sha256;         ///< of the files that it names; empty without any
  std::optional<int> exit_code;     ///< absent while it has not ended; 128 + n for signal n
  std::string status;               ///< of its certificate; else "not run", "bad input", "failed", "crashed"
  std::string reason;
  /// In the order in which they were found: relative, bound, cells, dofs, ...; see docs/output.md.
  std::vector<std::pair<std::string, std::optional<double>>> figures;
  std::string units{};  ///< `units` of its certificate, JSON; empty: the case names none, or they are unknown
};

struct SweepRecord
{
  std::string title;
  std::string file;
  std::vector<std::string> keys;
  std::vector<SweepRun> runs;
  std::vector<std::string> titles{};  ///< of the keys: label and unit of a parameter, else the key
  std::string purpose{};
};

/// Reads status, reason and figures of a run that has ended, from certificate.json and contact.csv in its
/// directory; figures only where the certificate is the final one.
void read_results(const std::filesystem::path& directory, SweepRun& run);

/// The complete runs of an earlier sweep in this directory, according to its sweep.json, that solved the same
/// effective case and the same files; with their exit codes.
[[nodiscard]] std::map<std::string, int> complete_runs(const std::filesystem::path& directory,
                                                       const SweepRecord& sweep);

/// A row per run: name, the keys, status, reason, then every figure of any run.
[[nodiscard]] std::string sweep_csv(const SweepRecord& sweep);
[[nodiscard]] io::Json sweep_object(const SweepRecord& sweep);

/// Writes sweep.csv and, with sweep_object(), sweep.json. Throws WriteError when a file cannot be written.
void write_sweep(const std::filesystem::path& directory, const SweepRecord& sweep, const io::Json& object);

/// A line on a run that has ended.
[[nodiscard]] std::string sweep_line(const SweepRecord& sweep, const SweepRun& run);

}  // namespace tribound::app
