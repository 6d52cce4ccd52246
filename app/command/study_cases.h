#pragma once

/// @file study_cases.h
/// What a study solves, and where it looks for the truth, derived from the case.

#include <string>

#include "tribound/case/config.h"

namespace tribound::app
{

/// The case as variant `name` of the study, one of variant_names.
[[nodiscard]] case_file::Config variant_config(const case_file::Config& config, const std::string& name);

/// The case of the reference solution, its bound to be at most `required` of ||sigma||. Its Newton iterates
/// are ten times closer to convergence than those it is to measure.
[[nodiscard]] case_file::Config reference_config(const case_file::Config& config, double required);

}  // namespace tribound::app
