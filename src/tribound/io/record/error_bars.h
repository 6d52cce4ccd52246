#pragma once

/// @file error_bars.h
/// What is written of the error in the energy norm.

#include <optional>
#include <string>

#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// Of the error in the energy norm, if there is one.
[[nodiscard]] std::optional<double> energy_bound(const LevelRecord& level);

/// bound / ||u_h||_en; nothing without a bound, or where u_h stores nothing.
[[nodiscard]] std::optional<double> relative_energy_bound(const LevelRecord& level);

/// What the bound is one of, in words: "the exact solution".
[[nodiscard]] const char* words_of(certify::EnergyTarget target);

/// What the bound guarantees, as a sentence of the certificate; empty without one.
[[nodiscard]] std::string words_of_guarantee(const LevelRecord& level);

/// Adds `energy_error` and, where it is null, `energy_reason`.
void add_energy_error(Json& object, const LevelRecord& level);

}  // namespace tribound::io
