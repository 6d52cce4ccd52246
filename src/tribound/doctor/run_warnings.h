#pragma once

/// @file run_warnings.h
/// What a user should look at in a result before trusting it: the bound is about the discrete solution, these
/// are about the model behind it and about reading local values.

#include <span>
#include <string>
#include <vector>

#include "tribound/doctor/solution_facts.h"
#include "tribound/io/record/report.h"

namespace tribound::doctor
{

/// Warnings about the solution of a level with its contact; docs/doctor.md explains every code.
[[nodiscard]] std::vector<io::RunWarning> run_warnings(const io::LevelRecord& level,
                                                       std::span<const ContactOutcome> outcomes);

}  // namespace tribound::doctor
