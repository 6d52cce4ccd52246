#pragma once

/// @file units.h
/// The units that the numbers of a case look like, and whether those that it names fit them.

#include <optional>
#include <string_view>
#include <vector>

#include "tribound/doctor/load_facts.h"
#include "tribound/problem/units.h"

namespace tribound::doctor
{

/// Units in which Young's moduli are those of solids people compute with (rubber, 1 MPa, to diamond,
/// 1200 GPa), the body is between 0.1 mm and 1 km long, and a body force, if there is one, is near the weight
/// of something (is_weight()). The most usual first; of (m, N), (mm, N), (m, MN), (m, kN), (mm, kN). Empty
/// for what looks like none, as a scaled model with E = 1.
[[nodiscard]] std::vector<problem::Units> plausible_units(const LoadFacts& loads);

/// The solids of some stiffness.
struct Solids
{
  double from;  ///< E; Pa
  double to;
  std::string_view name;
  bool is_soft;  ///< softer than what structures are built of
};

/// Those as stiff as E, in Pa, from gels, 10 kPa, to diamond, 1200 GPa; nothing beyond.
[[nodiscard]] std::optional<Solids> solids_as_stiff(double E);

struct StressUnit
{
  std::string_view name;
  double pascals;
};

/// The unit in which E, which is no stiffness of a structure in `units`, would be one, 1 to 1200 GPa, if
/// there is one: the largest of GPa, MPa, kPa and Pa; or ksi or psi where `units` have such stresses.
[[nodiscard]] std::optional<StressUnit> meant_unit(double E, const problem::Units& units);

/// Whether a body force, in N/m^3, is near the weight of something: 500 to 25000 kg/m^3, gravity 9.81 m/s^2,
/// by a factor of up to 5 either way.
[[nodiscard]] bool is_weight(double body_force);

}  // namespace tribound::doctor
