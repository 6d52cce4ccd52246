#include "tribound/doctor/units.h"

#include <algorithm>
#include <array>

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
constexpr Range length{1e-4, 1e3};                        // m
constexpr Range weight{500 * 9.81 / 5, 25e3 * 9.81 * 5};  // N/m^3

bool is_plausible(const UnitSystem& units, const LoadFacts& loads)
{
  const bool stiff = std::ranges::all_of(
      loads.materials, [&](const RegionMaterial& m) { return young.contains(m.E * units.pascals); });
  const double force_density = loads.largest_body_force * units.pascals / units.metres;
  return stiff && length.contains(loads.size * units.metres) &&
         (force_density == 0 || weight.contains(force_density));
}

}  // namespace

std::vector<UnitSystem> plausible_units(const LoadFacts& loads)
{
  if (loads.smallest_E == 1) return {};  // what scaled models have, and hardly any solid to the last digit
  const std::array<UnitSystem, 5> known = {{{"m", "N", "Pa", 1, 1},
                                            {"mm", "N", "MPa", 1e-3, 1e6},
                                            {"m", "MN", "MPa", 1, 1e6},
                                            {"m", "kN", "kPa", 1, 1e3},
                                            {"mm", "kN", "GPa", 1e-3, 1e9}}};
  std::vector<UnitSystem> plausible;
  std::ranges::copy_if(known, std::back_inserter(plausible),
                       [&](const UnitSystem& units) { return is_plausible(units, loads); });
  return plausible;
}

}  // namespace tribound::doctor
