#pragma once

/// @file console.h
/// What a user sees: results on stdout, progress on stderr.

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
/// A step, with the relative bound after it where that is known.
[[nodiscard]] std::string newton_text(const solve::NewtonStep& step,
                                      std::optional<double> relative_bound = {});
/// One line on a level: its size, Newton steps, bound and time.
[[nodiscard]] std::string level_text(const io::LevelRecord& level);
/// A pass over all load steps that begins, or a finer mesh in the middle of one.
[[nodiscard]] std::string mesh_text(std::string_view caption, std::int64_t cells, std::int64_t dofs);
/// The bound of the last level, component by component, and what it guarantees; nothing without a bound.
[[nodiscard]] std::string certificate_text(const io::RunRecord& run);
/// A paragraph for each warning; nothing without any.
[[nodiscard]] std::string warnings_text(std::span<const doctor::Finding> warnings);
/// Resultants, largest displacement, the certificate, warnings, status, and where the files are.
[[nodiscard]] std::string summary_text(const io::RunRecord& run, const std::string& directory);
/// The end of the summary: status, and where the files are.
[[nodiscard]] std::string verdict_text(const io::RunRecord& run, const std::string& directory);
/// `tribound check`: everything that was read; `solver` names the linear solver that would be taken.
[[nodiscard]] std::string check_text(const io::CaseFacts& facts, const io::MeshFacts& mesh,
                                     const std::string& solver);
/// What the doctor found, with advice, and how many warnings and notes there are.
[[nodiscard]] std::string findings_text(std::span<const doctor::Finding> findings);
/// `tribound info`.
[[nodiscard]] std::string info_text(const io::BuildFacts& build);

void print_header(const io::CaseFacts& facts, const io::MeshFacts& mesh);
void print_level(const io::LevelRecord& level);
void print_mesh(std::string_view caption, std::int64_t cells, std::int64_t dofs);
void print_summary(const io::RunRecord& run, const std::string& directory);
/// Warnings and status only.
void print_verdict(const io::RunRecord& run, const std::string& directory);
void print_check(const io::CaseFacts& facts, const io::MeshFacts& mesh, const std::string& solver,
                 std::span<const doctor::Finding> findings, bool as_json);
void print_info(const io::BuildFacts& build);

/// One line per Newton step on stderr, where somebody can be watching: stderr is a terminal and the user has
/// not asked for quiet.
class Progress
{
 public:
  explicit Progress(bool quiet);

  void operator()(const solve::NewtonStep& step, std::optional<double> relative_bound = {}) const;
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
