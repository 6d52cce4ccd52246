#pragma once

/// @file run_warnings.h
/// What to check in a result before trusting it. The bound is about the discrete solution; these warnings are
/// about the underlying model and about local values.

#include <optional>
#include <span>
#include <vector>

#include "tribound/certify/bound/estimate.h"
#include "tribound/doctor/findings.h"
#include "tribound/doctor/solution_facts.h"
#include "tribound/problem/units.h"

namespace tribound::doctor
{

/// What is known of a solution besides its contact.
struct SolvedFigures
{
  std::optional<certify::Bound> bound;
  double sigma_norm = 0;        ///< ||sigma(u_h)||
  double max_displacement = 0;  ///< largest |u| at a node
  problem::Units units{};       ///< that the case names
};

/// Warnings about the solution of a level with its contact; docs/doctor.md explains every code. The first
/// number of a finding is the value that was compared with a limit.
[[nodiscard]] std::vector<Finding> run_warnings(const SolvedFigures& solved,
                                                std::span<const ContactOutcome> outcomes);

}  // namespace tribound::doctor
