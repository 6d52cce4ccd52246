#pragma once

/// @file error_bars.h
/// What is written of the error in the energy norm.

#include <optional>
#include <string>

#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/facts.h"
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
[[nodiscard]] std::string words_of_guarantee(const LevelRecord& level, const CaseFacts& facts);

/// A quantity in words: "1.646 N/mm, guaranteed between 1.63 and 1.66 (energy bound)"; `unit` may be empty.
[[nodiscard]] std::string words_of(const certify::QuantityInterval& quantity, const std::string& unit);

/// Whether every interval of a level has a point in common with that of a better solution of the same
/// problem, as both hold the number of the exact one; nothing where none can be compared
/// (certify::compare_intervals), as with Coulomb's friction.
[[nodiscard]] std::optional<bool> intervals_agree(const LevelRecord& level, const LevelRecord& better);

/// A row for each quantity of each level, levels as `levels` of the certificate has them.
[[nodiscard]] std::string quantities_csv(const Json& levels, const CaseFacts& facts);

/// Adds `energy_error` and, where it is null, `energy_reason`; and `quantities`, where there are any.
void add_energy_error(Json& object, const LevelRecord& level);

}  // namespace tribound::io
