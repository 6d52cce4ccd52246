#pragma once

/// @file axisymmetry.h
/// Cases of bodies of revolution: model = "axisymmetric".

#include "tribound/case/config.h"
#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

[[nodiscard]] Key model_key();

/// Reads `model`. Throws InputError for whatever in the case has no meaning on a meridian, or is not there
/// yet.
void read_model(const TableReader& root, Config& config);

}  // namespace tribound::case_file
