#pragma once

/// @file forecast.h
/// What a run will need, from how its bound has decreased so far.

#include <string>

#include "tribound/io/record/report.h"

namespace tribound::app
{

/// "at this rate 1 % needs 1.2 million unknowns": the rate is fitted to the last half of the levels. Empty
/// where the tolerance is reached, or less than three levels have a bound.
[[nodiscard]] std::string forecast_text(const io::RunRecord& run, long max_dofs);

}  // namespace tribound::app
