#pragma once

/// @file error_bars.h
/// Output of the error in the energy norm.

#include <optional>
#include <string>

#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// From the energies and energy norms of one radian to those of the full circle, whose energies are `circle`
/// times as large. Its quantities are those of the full circle already.
void scale_energies(certify::EnergyBound& bound, double circle);

/// The bound of the error in the energy norm, if there is one.
[[nodiscard]] std::optional<double> energy_bound(const LevelRecord& level);

/// bound / ||u_h||_en; nothing without a bound, or where u_h has no energy.
[[nodiscard]] std::optional<double> relative_energy_bound(const LevelRecord& level);

/// The solution whose error is bounded, in words: "the exact solution".
[[nodiscard]] const char* words_of(certify::EnergyTarget target);

/// What the bound guarantees, as a sentence of the certificate; empty without a bound.
[[nodiscard]] std::string words_of_guarantee(const LevelRecord& level, const CaseFacts& facts);

/// A quantity in words: "1.646 N/mm, guaranteed between 1.63 and 1.66 (energy bound)", or the number itself
/// where it is exact; `unit` may be empty.
[[nodiscard]] std::string words_of(const certify::QuantityInterval& quantity, const std::string& unit);

/// Whether every interval of a level overlaps that of a better solution of the same problem: both contain the
/// exact value. Nothing where none can be compared (certify::compare_intervals), as with Coulomb friction.
[[nodiscard]] std::optional<bool> intervals_agree(const LevelRecord& level, const LevelRecord& better);

/// A row for each quantity of each level, with levels as in `levels` of the certificate.
[[nodiscard]] std::string quantities_csv(const Json& levels, const CaseFacts& facts);

/// Adds `energy_error` and, where that is null, `energy_reason`; and `quantities`, if there are any.
void add_energy_error(Json& object, const LevelRecord& level);

}  // namespace tribound::io
