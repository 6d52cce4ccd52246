#pragma once

/// @file study_cases.h
/// The cases of a study and of its reference solution, derived from the given case.

#include <string>

#include "tribound/case/config.h"

namespace tribound::app
{

/// The case as variant `name` of the study, one of variant_names.
[[nodiscard]] case_file::Config variant_config(const case_file::Config& config, const std::string& name);

/// The case of the reference solution, with a bound of at most `required` times ||sigma||. Its Newton
/// iterates are ten times closer to convergence than those to be measured.
[[nodiscard]] case_file::Config reference_config(const case_file::Config& config, double required);

}  // namespace tribound::app
