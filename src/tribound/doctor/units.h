#pragma once

/// @file units.h
/// The units suggested by the numbers of a case, and whether the named units fit them.

#include <optional>
#include <string_view>
#include <vector>

#include "tribound/doctor/load_facts.h"
#include "tribound/problem/units.h"

namespace tribound::doctor
{

/// Units in which Young's moduli are those of common solids (rubber, 1 MPa, to diamond, 1200 GPa), the body
/// is between 0.1 mm and 1 km long, and a body force, if there is one, is close to a weight (is_weight()).
/// Candidates are (m, N), (mm, N), (m, MN), (m, kN), (mm, kN); the most usual come first. Empty where none
/// fits, as for a scaled model with E = 1.
[[nodiscard]] std::vector<problem::Units> plausible_units(const LoadFacts& loads);

/// A class of solids by stiffness.
struct Solids
{
  double from;  ///< E; Pa
  double to;
  std::string_view name;
  bool is_soft;  ///< softer than structural materials
};

/// The class with stiffness E, in Pa, from gels, 10 kPa, to diamond, 1200 GPa; nothing outside.
[[nodiscard]] std::optional<Solids> solids_as_stiff(double E);

struct StressUnit
{
  std::string_view name;
  double pascals;
};

/// For an E that is not structural in `units`: the unit in which it would be, 0.5 to 1200 GPa, if there is
/// one. This is the largest of GPa, MPa, kPa and Pa; or ksi or psi where `units` have such stresses.
[[nodiscard]] std::optional<StressUnit> meant_unit(double E, const problem::Units& units);

/// Whether a body force, in N/m^3, is close to a weight: that of 500 to 25000 kg/m^3 with gravity 9.81 m/s^2,
/// up to a factor of 5 either way.
[[nodiscard]] bool is_weight(double body_force);

}  // namespace tribound::doctor
