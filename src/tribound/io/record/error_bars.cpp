#include "tribound/io/record/error_bars.h"

#include <fmt/format.h>

#include <cmath>

#include "tribound/certify/energy/interval_comparison.h"
#include "tribound/io/file/json.h"

namespace tribound::io
{

namespace
{

bool has_bound(const LevelRecord& level)
{
  return level.energy && level.energy->reason.empty();
}

/// In which respects v and tau are not admissible, in words; empty: none.
std::string words_of_remainders(const certify::EnergyBound& bound, const CaseFacts& facts)
{
  std::string text;
  if (bound.gap_remainder > 0)
    text += fmt::format("; gaps are interpolated, they differ by {:.3g}{} where they were compared",
                        bound.gap_remainder, facts.behind(problem::UnitOf::length));
  if (bound.threshold_remainder > 0)
    text += fmt::format("; thresholds are interpolated, they differ by {:.3g}{} where they were compared",
                        bound.threshold_remainder, facts.behind(problem::UnitOf::stress));
  if (bound.direction_remainder > 0)
    text += fmt::format(
        "; directions of contact are interpolated, they differ by {:.3g} where they were compared",
        bound.direction_remainder);
  return text;
}

}  // namespace

void scale_energies(certify::EnergyBound& bound, double circle)
{
  using certify::EnergyBound;
  for (double EnergyBound::*const energy : {&EnergyBound::gap, &EnergyBound::contact, &EnergyBound::springs})
    bound.*energy *= circle;
  for (double EnergyBound::*const norm :
       {&EnergyBound::bound, &EnergyBound::b_v, &EnergyBound::mid, &EnergyBound::dist,
        &EnergyBound::correction, &EnergyBound::oscillation, &EnergyBound::transfer})
    bound.*norm *= std::sqrt(circle);
}

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

std::string words_of_guarantee(const LevelRecord& level, const CaseFacts& facts)
{
  if (!has_bound(level)) return {};
  return fmt::format("the error in the energy norm: the distance of the computed displacement {}from {}{}",
                     level.load_step ? "of a load step, after the computed slip of those before it, " : "",
                     words_of(level.energy->target), words_of_remainders(*level.energy, facts));
}

std::string words_of(const certify::QuantityInterval& quantity, const std::string& unit)
{
  const auto with_unit = [&](double number)
  { return fmt::format("{:.6g}{}{}", number, unit.empty() ? "" : " ", unit); };
  const std::string value = with_unit(quantity.value);
  if (!quantity.reason.empty()) return value + ", without error bar: " + quantity.reason;
  const std::string note = quantity.note.empty() ? std::string() : "; " + quantity.note;
  if (quantity.exact)
  {
    const std::string known = with_unit((quantity.lower + quantity.upper) / 2);
    return fmt::format("{}, exact ({}){}{}", known, quantity.basis,
                       known == value ? "" : "; of the computed solution " + value, note);
  }
  return fmt::format("{}, guaranteed between {:.6g} and {:.6g} ({}){}", value, quantity.lower, quantity.upper,
                     quantity.basis, note);
}

namespace
{

Json json(const certify::QuantityInterval& quantity)
{
  const bool is_known = quantity.reason.empty();
  return {{"name", quantity.name},
          {"value", quantity.value},
          {"lower", is_known ? Json(quantity.lower) : Json(nullptr)},
          {"upper", is_known ? Json(quantity.upper) : Json(nullptr)},
          {"exact", quantity.exact},
          {"rests_on", text_or_null(quantity.basis)},
          {"note", text_or_null(quantity.note)},
          {"reason", text_or_null(quantity.reason)}};
}

std::optional<double> known(const Json& value)
{
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

}  // namespace

std::optional<bool> intervals_agree(const LevelRecord& level, const LevelRecord& better)
{
  if (!level.energy || !better.energy) return std::nullopt;
  std::optional<bool> all;
  for (const certify::QuantityInterval& quantity : level.energy->quantities)
    for (const certify::QuantityInterval& other : better.energy->quantities)
    {
      if (quantity.name != other.name) continue;
      const auto agree = certify::compare_intervals(*level.energy, quantity, *better.energy, other).agree;
      if (agree) all = all.value_or(true) && *agree;
    }
  return all;
}

std::string quantities_csv(const Json& levels, const CaseFacts& facts)
{
  const auto row = [&facts](const Json& level, const Json& quantity) -> TableRow
  {
    return {{"level", level.at("level").get<long>()},
            {"dofs", level.at("dofs").get<long>()},
            {"name", quantity.at("name").get<std::string>()},
            {"value", known(quantity.at("value"))},
            {"lower", known(quantity.at("lower"))},
            {"upper", known(quantity.at("upper"))},
            {"exact", quantity.at("exact").get<bool>() ? 1L : 0L},
            {"rests_on", quantity.at("rests_on").is_string() ? quantity.at("rests_on").get<std::string>()
                                                             : std::string()},
            {"unit", facts.unit_of(quantity.at("name").get<std::string>())}};
  };
  std::vector<TableRow> rows;
  for (const Json& level : levels)
    if (const auto quantities = level.find("quantities"); quantities != level.end())
      for (const Json& quantity : *quantities) rows.push_back(row(level, quantity));
  return rows.empty() ? std::string() : csv_text(rows.front(), rows);
}

void add_energy_error(Json& object, const LevelRecord& level)
{
  if (level.energy)
    for (const certify::QuantityInterval& quantity : level.energy->quantities)
      object["quantities"].push_back(json(quantity));
  object["energy_error"] = nullptr;
  if (!has_bound(level))
  {
    object["energy_reason"] = level.energy  ? level.energy->reason
                              : level.bound ? "not computed on this mesh, see certify.energy"
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
      {"transfer", bound.transfer},
      {"cell_balance", bound.cell_balance},
      {"gap_remainder", bound.gap_remainder},
      {"threshold_remainder", bound.threshold_remainder},
      {"direction_remainder", bound.direction_remainder}};
}

}  // namespace tribound::io
