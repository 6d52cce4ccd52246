#include "tribound/doctor/units.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string>

namespace tribound::doctor
{

namespace
{

struct Range
{
  double from;
  double to;

  [[nodiscard]] bool contains(double value) const { return from <= value && value <= to; }
};

constexpr Range young{1e6, 1.2e12};                       // Pa
constexpr Range structural{5e8, 1.2e12};                  // Pa
constexpr Range length{1e-4, 1e3};                        // m
constexpr Range weight{500 * 9.81 / 5, 25e3 * 9.81 * 5};  // N/m^3

constexpr std::array<Solids, 6> solids = {{{1e4, 1e6, "gels and soft tissue", true},
                                           {1e6, 5e8, "rubber, soft plastics and soil", true},
                                           {5e8, 1e10, "plastics and wood", false},
                                           {1e10, 6e10, "concrete, rock and glass", false},
                                           {6e10, 4.5e11, "metals", false},
                                           {4.5e11, 1.2e12, "hard metal and diamond", false}}};

constexpr std::array<StressUnit, 4> si = {{{"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}, {"Pa", 1}}};
constexpr std::array<StressUnit, 2> imperial = {{{"ksi", 6.894757e6}, {"psi", 6.894757e3}}};

bool is_plausible(const problem::Units& units, const LoadFacts& loads)
{
  const bool stiff = std::ranges::all_of(
      loads.materials, [&](const RegionMaterial& m) { return young.contains(m.E * units.pascals()); });
  const double force_density = loads.largest_body_force * units.pascals() / units.metres();
  return stiff && length.contains(loads.size * units.metres()) &&
         (force_density == 0 || is_weight(force_density));
}

}  // namespace

std::vector<problem::Units> plausible_units(const LoadFacts& loads)
{
  if (loads.smallest_E == 1) return {};  // usual in scaled models, and not exactly so in real solids
  const std::array<problem::Units, 5> known = {
      {{"m", "N"}, {"mm", "N"}, {"m", "MN"}, {"m", "kN"}, {"mm", "kN"}}};
  std::vector<problem::Units> plausible;
  std::ranges::copy_if(known, std::back_inserter(plausible),
                       [&](const problem::Units& units) { return is_plausible(units, loads); });
  return plausible;
}

std::optional<Solids> solids_as_stiff(double E)
{
  const auto* const found =
      std::ranges::find_if(solids, [E](const Solids& s) { return s.from <= E && E < s.to; });
  return found == solids.end() ? std::nullopt : std::optional(*found);
}

std::optional<StressUnit> meant_unit(double E, const problem::Units& units)
{
  const std::string named = units.label(problem::UnitOf::stress);
  const bool is_imperial = std::ranges::count(imperial, named, &StressUnit::name) > 0;
  for (const StressUnit& unit :
       is_imperial ? std::span<const StressUnit>(imperial) : std::span<const StressUnit>(si))
    if (unit.name != named && structural.contains(E * unit.pascals)) return unit;
  return std::nullopt;
}

bool is_weight(double body_force)
{
  return weight.contains(body_force);
}

}  // namespace tribound::doctor
