#pragma once

/// @file console.h
/// Text for the user: results on stdout, progress on stderr.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tribound/doctor/findings.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/report.h"
#include "tribound/solve/newton.h"

namespace tribound::app
{

/// The texts of the program; each ends with a newline.
[[nodiscard]] std::string header_text(const io::CaseFacts& facts, const io::MeshFacts& mesh);
/// A step, with the relative bound after it if known.
[[nodiscard]] std::string newton_text(const solve::NewtonStep& step,
                                      std::optional<double> relative_bound = {});
/// One line on a level: its size, Newton steps, bound and time.
[[nodiscard]] std::string level_text(const io::LevelRecord& level);
/// The start of a pass over all load steps, or a finer mesh within one.
[[nodiscard]] std::string mesh_text(std::string_view caption, std::int64_t cells, std::int64_t dofs);
/// The bound of the last level, component by component, and what it guarantees; nothing without a bound.
[[nodiscard]] std::string certificate_text(const io::RunRecord& run);
/// A paragraph for each warning; nothing if there are none.
[[nodiscard]] std::string warnings_text(std::span<const doctor::Finding> warnings);
/// Resultants, largest displacement, the certificate, warnings, status, and where the files are.
[[nodiscard]] std::string summary_text(const io::RunRecord& run, const std::string& directory);
/// The end of the summary: status, and where the files are.
[[nodiscard]] std::string verdict_text(const io::RunRecord& run, const std::string& directory);
/// The balance of forces as a table, with the units of the case. Values below 1e-9 of the largest of their
/// kind are shown as 0.
[[nodiscard]] std::string balance_text(const certify::Balance& balance, const io::CaseFacts& facts);
/// Sections and probes as tables; empty where there are none.
[[nodiscard]] std::string observations_text(const io::LevelRecord& level, const io::CaseFacts& facts);
/// A forecast from the decrease of the bound so far: "at this rate 1 % needs 1.2 million unknowns". The rate
/// is fitted to the last half of the levels. Empty where the tolerance is reached, or fewer than three levels
/// have a bound.
[[nodiscard]] std::string forecast_text(const io::RunRecord& run, long max_dofs);
/// `tribound check`: everything that was read; `solver` names the linear solver that would be used.
[[nodiscard]] std::string check_text(const io::CaseFacts& facts, const io::MeshFacts& mesh,
                                     const std::string& solver);
/// The findings of the doctor, with advice, and the numbers of warnings and notes.
[[nodiscard]] std::string findings_text(std::span<const doctor::Finding> findings);
/// Both as JSON with the fields of docs/output.md.
[[nodiscard]] std::string check_json(const io::CaseFacts& facts, const io::MeshFacts& mesh,
                                     const std::string& solver, std::span<const doctor::Finding> findings);
/// `tribound info`; `report_page`: the path of its template, empty where there is none.
[[nodiscard]] std::string info_text(const io::BuildFacts& build, const std::string& report_page);

/// One line per Newton step on stderr, if somebody may be watching: stderr is a terminal and the user has not
/// asked for quiet.
class Progress
{
 public:
  explicit Progress(bool quiet);

  void operator()(const adapt::CertifiedStep& step) const;
  /// Whether the user has asked for quiet.
  [[nodiscard]] bool quiet() const { return quiet_; }
  /// A line about a stage, such as "reading block.msh".
  void stage(const std::string& text) const;

 private:
  void show(const std::string& text) const;

  bool quiet_;
  bool shown_;
};

}  // namespace tribound::app
