#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "tribound/doctor/findings.h"

namespace tribound::doctor
{

using problem::UnitOf;

namespace
{

constexpr double steel = 77e3;  // N/m^3

/// "m, N, Pa (E = 2.1e+11 Pa, a body of 2 m)".
std::string in_words(const problem::Units& units, const LoadFacts& loads)
{
  const std::string length = units.label(UnitOf::length);
  const std::string stress = units.label(UnitOf::stress);
  return fmt::format("{}, {}, {} (E = {:.3g} {}, a body of {:.3g} {})", length, units.label(UnitOf::force),
                     stress, loads.smallest_E, stress, loads.size, length);
}

Finding guess(const Diagnosis& diagnosis)
{
  Finding finding{.code = "units"};
  finding.numbers = {{"E", diagnosis.loads.smallest_E},
                     {"size", diagnosis.loads.size},
                     {"body_force", diagnosis.loads.largest_body_force}};
  if (diagnosis.guesses.empty())
  {
    finding.severity = Severity::note;
    finding.text =
        fmt::format("E = {:.3g} with a body of size {:.3g}{} fits no usual system of units",
                    diagnosis.loads.smallest_E, diagnosis.loads.size,
                    diagnosis.loads.largest_body_force > 0
                        ? fmt::format(" and a body force of {:.3g}", diagnosis.loads.largest_body_force)
                        : "");
    finding.advice =
        "fine for a scaled model; otherwise do not mix systems: m with N and Pa, mm with N and MPa, "
        "m with MN and MPa";
    return finding;
  }
  constexpr std::size_t most_guesses = 2;
  std::vector<std::string> systems;
  for (std::size_t i = 0; i < std::min(most_guesses, diagnosis.guesses.size()); ++i)
    systems.push_back(in_words(diagnosis.guesses[i], diagnosis.loads));
  finding.text = fmt::format("a guess at the units: {}", fmt::join(systems, "; or "));
  finding.advice = fmt::format(
      "name them in the case, and results carry them: [units] with length = \"{}\" and force = \"{}\"",
      diagnosis.guesses[0].label(UnitOf::length), diagnosis.guesses[0].label(UnitOf::force));
  return finding;
}

/// "GPa? ...": the intended E, as far as it can be guessed.
std::string advice_on(double E, const problem::Units& units)
{
  const std::optional<StressUnit> meant = meant_unit(E, units);
  if (!meant) return "look at E and [units]: one of them is hardly meant so";
  return fmt::format("{}? Then it is E = {:.6g} in this case, whose stresses are in {}", meant->name,
                     E * meant->pascals / units.pascals(), units.label(UnitOf::stress));
}

Finding stiffness(const RegionMaterial& material, const problem::Units& units)
{
  Finding finding{.code = "units"};
  finding.numbers = {{"E", material.E}, {"pascals", material.E * units.pascals()}};
  const std::string which =
      fmt::format("E = {:.6g}{} of region \"{}\"", material.E, units.behind(UnitOf::stress), material.region);
  const std::optional<Solids> solids = solids_as_stiff(material.E * units.pascals());
  finding.text = solids ? fmt::format("{} is that of {}", which, solids->name)
                        : which + " is that of no solid: they have 10 kPa (gels) to 1200 GPa (diamond)";
  if (solids && !solids->is_soft) return finding;
  finding.severity = solids ? Severity::note : Severity::warning;
  finding.advice = advice_on(material.E, units);
  return finding;
}

/// Nothing where the body force is near the weight of something, or zero.
std::optional<Finding> weight(const Diagnosis& diagnosis)
{
  const double per_unit = diagnosis.units.pascals() / diagnosis.units.metres();
  const double force = diagnosis.loads.largest_body_force;
  if (force == 0 || is_weight(force * per_unit)) return {};
  Finding finding{.code = "body_force", .severity = Severity::note};
  finding.numbers = {{"body_force", force}, {"steel", steel / per_unit}};
  const std::string unit = diagnosis.behind(UnitOf::body_force);
  finding.text = fmt::format("the largest body force, {:.3g}{}, is {:.2g} times the weight of steel", force,
                             unit, force * per_unit / steel);
  finding.advice = fmt::format("if it is a weight, look at its units: steel has {:.3g}{}, water {:.3g}{}",
                               steel / per_unit, unit, 9810 / per_unit, unit);
  return finding;
}

}  // namespace

std::vector<Finding> unit_findings(const Diagnosis& diagnosis)
{
  if (!diagnosis.units.are_named()) return {guess(diagnosis)};
  std::vector<Finding> findings;
  std::set<double> seen;
  for (const RegionMaterial& material : diagnosis.loads.materials)
    if (seen.insert(material.E).second) findings.push_back(stiffness(material, diagnosis.units));
  if (std::optional<Finding> heavy = weight(diagnosis)) findings.push_back(*std::move(heavy));
  return findings;
}

}  // namespace tribound::doctor
