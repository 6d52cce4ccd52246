#pragma once

/// @file units.h
/// The system of units that the numbers of a case look like.

#include <string>
#include <vector>

#include "tribound/doctor/load_facts.h"

namespace tribound::doctor
{

struct UnitSystem
{
  std::string length;
  std::string force;
  std::string stress;
  double metres = 1;   ///< in a unit of length
  double pascals = 1;  ///< in a unit of stress
};

/// Systems in which Young's moduli are those of solids people compute with (rubber, 1 MPa, to diamond,
/// 1200 GPa), the body is between 0.1 mm and 1 km long, and a body force, if there is one, is near the weight
/// of something (500 to 25000 kg/m^3, gravity 9.81 m/s^2, by a factor of up to 5 either way). The most usual
/// first; of SI (m, N, Pa), (mm, N, MPa), (m, MN, MPa), (m, kN, kPa), (mm, kN, GPa). Empty for what looks
/// like none, as a scaled model with E = 1.
[[nodiscard]] std::vector<UnitSystem> plausible_units(const LoadFacts& loads);

}  // namespace tribound::doctor
