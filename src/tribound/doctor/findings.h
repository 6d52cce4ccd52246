#pragma once

/// @file findings.h
/// The facts of the doctor, assessed and expressed in words.

#include <string>
#include <utility>
#include <vector>

#include "tribound/doctor/diagnosis.h"
#include "tribound/doctor/place.h"

namespace tribound::doctor
{

enum class Severity
{
  ok,
  note,    ///< worth knowing
  warning  ///< likely to spoil the result
};

/// "ok", "note", "warning".
[[nodiscard]] const char* to_string(Severity severity);

/// One finding; docs/doctor.md explains every code.
struct Finding
{
  std::string code;
  Severity severity = Severity::ok;
  std::string text{};                                     ///< a sentence
  std::vector<std::pair<std::string, double>> numbers{};  ///< by name
  Place where{};                                          ///< empty: no particular place
  std::string advice{};                                   ///< empty where nothing is wrong
  std::string boundary{};                                 ///< name of the group; empty: no particular one
};

/// All findings before solving, in the order of the case: supports, contact, loads, mesh, cost.
[[nodiscard]] std::vector<Finding> findings(const Diagnosis& diagnosis);

/// Findings about contact boundaries.
[[nodiscard]] std::vector<Finding> contact_findings(const Diagnosis& diagnosis);

/// Findings about pairs of bodies in contact.
[[nodiscard]] std::vector<Finding> pair_findings(const Diagnosis& diagnosis);

/// Findings about the units named by the case, or a guess at them.
[[nodiscard]] std::vector<Finding> unit_findings(const Diagnosis& diagnosis);

/// Findings about memory and time.
[[nodiscard]] std::vector<Finding> cost_findings(const Diagnosis& diagnosis);

/// `boundary "base" at (0.5, 1)`, as far as known; empty if nothing is.
[[nodiscard]] std::string location(const Finding& finding);

/// "(0.5, 1)", with six digits.
[[nodiscard]] std::string describe(const Place& where);

}  // namespace tribound::doctor
