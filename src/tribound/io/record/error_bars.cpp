#include "tribound/io/record/error_bars.h"

#include <fmt/format.h>

#include <cmath>

#include "tribound/io/file/json.h"

namespace tribound::io
{

namespace
{

bool has_bound(const LevelRecord& level)
{
  return level.energy && level.energy->reason.empty();
}

/// What v and tau are not admissible for, in words; empty: nothing.
std::string words_of_remainders(const certify::EnergyBound& bound)
{
  std::string text;
  if (bound.gap_remainder > 0)
    text += fmt::format("; gaps are interpolated, they differ by {:.3g} where they were compared",
                        bound.gap_remainder);
  if (bound.threshold_remainder > 0)
    text += fmt::format("; thresholds are interpolated, they differ by {:.3g} where they were compared",
                        bound.threshold_remainder);
  if (bound.loads_remainder > 0)
    text += fmt::format("; loads are projected, what is left has the weighted norm {:.3g}",
                        bound.loads_remainder);
  return text;
}

}  // namespace

std::optional<double> energy_bound(const LevelRecord& level)
{
  return has_bound(level) ? std::optional(level.energy->bound) : std::nullopt;
}

std::optional<double> relative_energy_bound(const LevelRecord& level)
{
  if (!has_bound(level) || !(level.figures.energy > 0)) return std::nullopt;
  return level.energy->bound / std::sqrt(level.figures.energy);
}

const char* words_of(certify::EnergyTarget target)
{
  return target == certify::EnergyTarget::solution
             ? "the exact solution"
             : "the exact solution for the computed friction threshold, not of Coulomb's law itself";
}

std::string words_of_guarantee(const LevelRecord& level)
{
  if (!has_bound(level)) return {};
  return fmt::format(
      "the error in the energy norm (energy_error): the distance of the computed displacement from {}{}",
      words_of(level.energy->target), words_of_remainders(*level.energy));
}

void add_energy_error(Json& object, const LevelRecord& level)
{
  object["energy_error"] = nullptr;
  if (!has_bound(level))
  {
    object["energy_reason"] = level.energy      ? level.energy->reason
                              : level.load_step ? "it is not bounded over load steps"
                              : level.bound     ? "not asked for: certify.energy"
                                                : "there is no bound of the residual";
    return;
  }
  const certify::EnergyBound& bound = *level.energy;
  object["energy_error"] = {
      {"bound", bound.bound},
      {"relative", number_or_null(relative_energy_bound(level))},
      {"guaranteed_for",
       bound.target == certify::EnergyTarget::solution ? "solution" : "tresca_with_computed_threshold"},
      {"b_v", bound.b_v},
      {"mid", bound.mid},
      {"dist", bound.dist},
      {"gap", bound.gap},
      {"correction", bound.correction},
      {"contact", bound.contact},
      {"oscillation", bound.oscillation},
      {"cell_balance", bound.cell_balance},
      {"gap_remainder", bound.gap_remainder},
      {"threshold_remainder", bound.threshold_remainder},
      {"loads_remainder", bound.loads_remainder}};
}

}  // namespace tribound::io
