#pragma once

/// @file study_cases.h
/// What a study solves, and where it looks for the truth, derived from the case.

#include <optional>
#include <string>

#include "tribound/case/config.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/space.h"

namespace tribound::app
{

/// The case as variant `name` of the study, one of variant_names.
[[nodiscard]] case_file::Config variant_config(const case_file::Config& config, const std::string& name);

/// The case of the reference solution, its bound to be at most `required` of ||sigma||. Its Newton iterates
/// are ten times closer to convergence than those it is to measure.
[[nodiscard]] case_file::Config reference_config(const case_file::Config& config, double required);

/// The richest space of at most `max_dofs` in which the dual norm can be looked for, if there is one.
template <int dim>
[[nodiscard]] std::optional<certify::RicherSpace> dual_space(const fem::LagrangeSpace<dim>& space,
                                                             long max_dofs);

}  // namespace tribound::app
