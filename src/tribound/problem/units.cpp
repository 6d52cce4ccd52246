#include "tribound/problem/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace tribound::problem
{

namespace
{

struct NamedUnit
{
  std::string_view name;
  double size;  ///< in SI
};

constexpr std::array<NamedUnit, 8> lengths = {{{"nm", 1e-9},
                                               {"um", 1e-6},
                                               {"mm", 1e-3},
                                               {"cm", 1e-2},
                                               {"in", 0.0254},
                                               {"ft", 0.3048},
                                               {"m", 1},
                                               {"km", 1e3}}};

constexpr double pound = 4.4482216152605;  // lbf in N
constexpr std::array<NamedUnit, 11> forces = {{{"nN", 1e-9},
                                               {"uN", 1e-6},
                                               {"dyn", 1e-5},
                                               {"mN", 1e-3},
                                               {"N", 1},
                                               {"lbf", pound},
                                               {"kgf", 9.80665},
                                               {"kN", 1e3},
                                               {"kip", 1e3 * pound},
                                               {"MN", 1e6},
                                               {"GN", 1e9}}};

struct NamedStress
{
  std::string_view force;
  std::string_view length;
  std::string_view name;
};

constexpr std::array<NamedStress, 4> imperial_stresses = {
    {{"lbf", "in", "psi"}, {"lbf", "ft", "psf"}, {"kip", "in", "ksi"}, {"kip", "ft", "ksf"}}};

/// Pascals to the powers 1000^-2, 1000^-1, ...
constexpr std::array<std::string_view, 7> si_stresses = {"uPa", "mPa", "Pa", "kPa", "MPa", "GPa", "TPa"};

double size_of(std::span<const NamedUnit> units, std::string_view name)
{
  const auto found = std::ranges::find(units, name, &NamedUnit::name);
  assert(found != units.end());
  return found->size;
}

std::vector<std::string> names_of(std::span<const NamedUnit> units)
{
  std::vector<std::string> names;
  for (const NamedUnit& unit : units) names.emplace_back(unit.name);
  return names;
}

std::string power(const std::string& unit, int exponent)
{
  return exponent == 1 ? unit : fmt::format("{}^{}", unit, exponent);
}

}  // namespace

Units::Units(std::string_view length, std::string_view force) : length_(length), force_(force) {}

std::string Units::label(UnitOf what, int dimension) const
{
  if (!are_named()) return {};
  const auto of_body = [&](const std::string& unit)
  { return dimension == 2 ? fmt::format("{}/{}", unit, length_) : unit; };
  switch (what)
  {
    case UnitOf::length:
      return length_;
    case UnitOf::boundary:
      return power(length_, dimension - 1);
    case UnitOf::body:
      return power(length_, dimension);
    case UnitOf::stress:
      return stress();
    case UnitOf::body_force:
      return fmt::format("{}/{}^3", force_, length_);
    case UnitOf::fracture_energy:
      return fmt::format("{}/{}", force_, length_);
    case UnitOf::force:
      return of_body(force_);
    case UnitOf::moment:
    case UnitOf::energy:
      return of_body(fmt::format("{} {}", force_, length_));
    case UnitOf::stress_norm:
      return fmt::format("{} {}{}", stress(), length_, dimension == 2 ? "" : "^(3/2)");
    case UnitOf::energy_norm:
      return fmt::format("({})^(1/2)", label(UnitOf::energy, dimension));
  }
  return {};
}

std::string Units::behind(UnitOf what, int dimension) const
{
  return are_named() ? " " + label(what, dimension) : std::string();
}

double Units::metres() const
{
  return are_named() ? size_of(lengths, length_) : 1;
}

double Units::newtons() const
{
  return are_named() ? size_of(forces, force_) : 1;
}

double Units::pascals() const
{
  return newtons() / (metres() * metres());
}

std::string Units::stress() const
{
  for (const NamedStress& known : imperial_stresses)
    if (known.force == force_ && known.length == length_) return std::string(known.name);
  const double thousands = std::log10(pascals()) / 3;
  const long number = std::lround(thousands) + 2;
  constexpr double round_off = 1e-9;
  if (std::abs(thousands - std::round(thousands)) < round_off && number >= 0 &&
      number < std::ssize(si_stresses))
    return std::string(si_stresses[static_cast<std::size_t>(number)]);
  return fmt::format("{}/{}^2", force_, length_);
}

std::vector<std::string> length_names()
{
  return names_of(lengths);
}

std::vector<std::string> force_names()
{
  return names_of(forces);
}

}  // namespace tribound::problem
